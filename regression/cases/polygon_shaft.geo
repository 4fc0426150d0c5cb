// A shaft of `flats` flats in a hub of as many, `shaft` and `hub` faces a flat.
DefineConstant[flats = 12, shaft = 5, hub = 4, order = 1];
bore = 5; radius = 10; rim = 15;

Macro Ring  // from `inner` to `outer`, of which `polygon` is the one with flats; curves and surfaces into inside[], outside[], faces[]
  inside[] = {}; outside[] = {}; spokes[] = {}; faces[] = {};
  c = newp; Point(c) = {0, 0, 0};
  p = newp;
  For k In {0:flats - 1}
    angle = 2 * Pi * k / flats;
    Point(p + 2 * k) = {inner * Cos(angle), inner * Sin(angle), 0};
    Point(p + 2 * k + 1) = {outer * Cos(angle), outer * Sin(angle), 0};
  EndFor
  For k In {0:flats - 1}
    n = (k + 1) % flats;
    l = newl;
    If (inner == radius)
      Line(l) = {p + 2 * k, p + 2 * n};
      Circle(l + 1) = {p + 2 * k + 1, c, p + 2 * n + 1};
    Else
      Circle(l) = {p + 2 * k, c, p + 2 * n};
      Line(l + 1) = {p + 2 * k + 1, p + 2 * n + 1};
    EndIf
    Line(l + 2) = {p + 2 * k, p + 2 * k + 1};
    inside[] += l; outside[] += l + 1; spokes[] += l + 2;
  EndFor
  For k In {0:flats - 1}
    n = (k + 1) % flats;
    loop = newll; Curve Loop(loop) = {inside[k], spokes[n], -outside[k], -spokes[k]};
    s = news; Plane Surface(s) = {loop};
    faces[] += s;
  EndFor
  Transfinite Curve {inside[], outside[]} = around + 1;
  Transfinite Curve {spokes[]} = 4;
  Transfinite Surface {faces[]};
  Recombine Surface {faces[]};
Return

inner = bore; outer = radius; around = shaft;
Call Ring;
Physical Surface("shaft", 1) = {faces[]};
Physical Curve("bore", 2) = {inside[]};
Physical Curve("outside", 3) = {outside[]};
inner = radius; outer = rim; around = hub;
Call Ring;
Physical Surface("hub", 4) = {faces[]};
Physical Curve("inside", 5) = {inside[]};
Physical Curve("rim", 6) = {outside[]};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1;
