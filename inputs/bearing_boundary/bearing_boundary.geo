// Cylindrical roller bearing: outer ring and inner ring of hexahedra swept along the axis z, and the surface of one of Z rollers without
// clearance. Rings have one sector a roller, with the middle of the sector on the roller, so that the sectors of the bore can be loaded one by one.
DefineConstant[ Z = 16 ];                          // rollers
DefineConstant[ bore = 30, F = 40, D = 54, OD = 65, width = 14 ]; // radii of bore, raceways and outside; width of all
DefineConstant[ m = 16 ];                          // cells round a sector, even
DefineConstant[ nr = 6, nz = 6, na = 10, nl = 3 ]; // cells through a ring, along the axis, round a quarter of a roller, from its core out

R = (D - F) / 2; pitch = (D + F) / 2; sector = 2 * Pi / Z;
Geometry.OldNewReg = 0;
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;

c = newp; Point(c) = {0, 0, 0};

Macro Ring   // r1, r2: radii; fills surfaces(), and inside() and outside() with its curves
  p1() = {}; p2() = {}; radial() = {}; inside() = {}; outside() = {}; surfaces() = {};
  For i In {0 : Z - 1}
    a = -Pi / 2 + (i - 0.5) * sector;
    p1(i) = newp; Point(p1(i)) = {r1 * Cos(a), r1 * Sin(a), 0};
    p2(i) = newp; Point(p2(i)) = {r2 * Cos(a), r2 * Sin(a), 0};
    radial(i) = newl; Line(radial(i)) = {p1(i), p2(i)};
    Transfinite Curve {radial(i)} = nr + 1;
  EndFor
  For i In {0 : Z - 1}
    j = (i + 1) % Z;
    inside(i) = newl; Circle(inside(i)) = {p1(i), c, p1(j)};
    outside(i) = newl; Circle(outside(i)) = {p2(i), c, p2(j)};
    Transfinite Curve {inside(i), outside(i)} = m + 1;
    loop = newll; Curve Loop(loop) = {radial(i), outside(i), -radial(j), -inside(i)};
    surfaces(i) = news; Plane Surface(surfaces(i)) = {loop};
    Transfinite Surface {surfaces(i)}; Recombine Surface {surfaces(i)};
  EndFor
Return

r1 = bore; r2 = F; Call Ring;
For i In {0 : Z - 1}
  e() = Extrude {0, 0, width} { Surface{surfaces(i)}; Layers{nz}; Recombine; };
  inner_volumes(i) = e(1); inner_raceway(i) = e(3); bore_faces(i) = e(5);
EndFor

r1 = D; r2 = OD; Call Ring;
For i In {0 : Z - 1}
  e() = Extrude {0, 0, width} { Surface{surfaces(i)}; Layers{nz}; Recombine; };
  outer_volumes(i) = e(1); housing(i) = e(3); outer_raceway(i) = e(5);
EndFor

// One roller, the lowest, by its surface alone: quadrilaterals, finer round it at the two lines of contact. The deck copies it.
a = -Pi / 2; y = -pitch;
o = newp; Point(o) = {0, y, 0};
For k In {0 : 3}
  b = a + Pi / 4 + k * Pi / 2;
  q(k) = newp; Point(q(k)) = {0.5 * R * Cos(b), y + 0.5 * R * Sin(b), 0};
  s(k) = newp; Point(s(k)) = {R * Cos(b), y + R * Sin(b), 0};
  spoke(k) = newl; Line(spoke(k)) = {q(k), s(k)};
  Transfinite Curve {spoke(k)} = nl + 1;
EndFor
For k In {0 : 3}
  n = (k + 1) % 4;
  edge(k) = newl; Line(edge(k)) = {q(k), q(n)};
  arc(k) = newl; Circle(arc(k)) = {s(k), o, s(n)};
  Transfinite Curve {edge(k)} = na + 1;
  If (k % 2)
    Transfinite Curve {arc(k)} = na + 1 Using Bump 4;
  Else
    Transfinite Curve {arc(k)} = na + 1;
  EndIf
  loop = newll; Curve Loop(loop) = {spoke(k), arc(k), -spoke(n), -edge(k)};
  front(k) = news; Plane Surface(front(k)) = {loop};
EndFor
loop = newll; Curve Loop(loop) = {edge(0), edge(1), edge(2), edge(3)};
front(4) = news; Plane Surface(front(4)) = {loop};
Transfinite Surface {front()}; Recombine Surface {front()};
For k In {0 : 4}
  e() = Extrude {0, 0, width} { Surface{front(k)}; Layers{nz}; Recombine; };
  back(k) = e(0);
  If (k < 4)
    round(k) = e(3);
  EndIf
EndFor

Physical Volume("inner_ring") = {inner_volumes()};
Physical Volume("outer_ring") = {outer_volumes()};
Physical Surface("inner_raceway") = {inner_raceway()};
Physical Surface("outer_raceway") = {outer_raceway()};
Physical Surface("housing") = {housing()};
Physical Surface("ends") = {front(), back()};
Physical Surface("round") = {round()};
Physical Surface("bore_0") = {bore_faces(0)};
Physical Surface("bore_1") = {bore_faces(1), bore_faces(Z - 1)};
Physical Surface("bore_2") = {bore_faces(2), bore_faces(Z - 2)};
Physical Surface("bore_3") = {bore_faces(3), bore_faces(Z - 3)};
