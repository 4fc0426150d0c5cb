// A cylindrical roller bearing in its plane: two rings and Z rollers without clearance, whose cells may be as large as the rollers.
DefineConstant[ Z = 12, F = 20, R = 4, bore = 14, outside = 36 ];  // rollers; radii of the inner raceway, the rollers, bore and outside
DefineConstant[ roller = 1, ring = 5 ];                            // sizes of cells

centre = newp; Point(centre) = {0, 0, 0, 1};

Macro Ring
  q() = {}; arc() = {};
  o = newp; Point(o) = {cx, cy, 0, h};
  For k In {0 : 3}
    q(k) = newp; Point(q(k)) = {cx + r * Cos(a + k * Pi / 2), cy + r * Sin(a + k * Pi / 2), 0, h};
  EndFor
  For k In {0 : 3}
    arc(k) = newl; Circle(arc(k)) = {q(k), o, q((k + 1) % 4)};
  EndFor
  loop = newll; Curve Loop(loop) = {arc()};
Return

cx = 0; cy = 0; a = 0.3; h = ring;
r = bore;
Call Ring;
inside = loop; bore() = arc();
r = F;
Call Ring;
inner_race() = arc();
s = news; Plane Surface(s) = {loop, inside};
Physical Surface("inner") = {s};
r = F + 2 * R;
Call Ring;
inside = loop; outer_race() = arc();
r = outside;
Call Ring;
housing() = arc();
s = news; Plane Surface(s) = {loop, inside};
Physical Surface("outer") = {s};

surfaces() = {}; curves() = {};
r = R; h = roller;
For i In {0 : Z - 1}
  a = -Pi / 2 + i * 2 * Pi / Z; cx = (F + R) * Cos(a); cy = (F + R) * Sin(a);
  Call Ring;
  s = news; Plane Surface(s) = {loop};
  surfaces() += {s}; curves() += {arc()};
EndFor
Physical Surface("rollers") = {surfaces()};
Physical Curve("bore") = {bore()};
Physical Curve("inner_race") = {inner_race()};
Physical Curve("outer_race") = {outer_race()};
Physical Curve("housing") = {housing()};
Physical Curve("rolling") = {curves()};
