// Two racks of two teeth each, with flanks of 30 degrees; those that look to the left on the lower rack touch those of the upper one; mm.
height = 4; up = 1.6; tip = 2.7; pitch = 10; flank = height * Tan(Pi / 6); size = 0.7;
Macro Outline  // of a rack: its teeth point to `way`, their feet are at y0, and the first of their flanks begins there at x0
  first = newp; Point(first) = {x0 - 3, y0 - 5 * way, 0, size}; Point(newp) = {x0 - 3, y0, 0, size};
  For i In {0:1}
    x = x0 + i * pitch;
    Point(newp) = {x, y0, 0, size}; Point(newp) = {x + flank, y0 + height * way, 0, size};
    Point(newp) = {x + flank + tip, y0 + height * way, 0, size}; Point(newp) = {x + 2 * flank + tip, y0, 0, size};
  EndFor
  last = newp; Point(last) = {x + 2 * flank + tip + 3, y0, 0, size}; Point(last + 1) = {x + 2 * flank + tip + 3, y0 - 5 * way, 0, size};
  line = newl;
  For p In {first:last}
    Line(newl) = {p, p + 1};
  EndFor
  back = newl; Line(back) = {last + 1, first};
  Curve Loop(way + 2) = {line:back}; Plane Surface(way + 2) = {way + 2};
Return
x0 = 0; y0 = 0; way = 1;
Call Outline;
Physical Surface("low") = {3}; Physical Curve("low_teeth") = {line + 1:back - 2}; Physical Curve("low_base") = {back};
x0 = up * Tan(Pi / 6) - tip - flank; y0 = height + up; way = -1;
Call Outline;
Physical Surface("high") = {1}; Physical Curve("high_teeth") = {line + 1:back - 2}; Physical Curve("high_base") = {back};
