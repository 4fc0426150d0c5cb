// Three squares of side 1 round a reentrant corner at the origin, whose free faces lie at theta = 135 and -135 degrees; n cells a side.
DefineConstant[ n = 2, quads = 1, order = 1, incomplete = 0 ];
Point(1) = {0, 0, 0};
For i In {0:6}
  a = (i - 3) * Pi / 4; r = i % 2 == 0 ? 1 : Sqrt(2);
  Point(2 + i) = {r * Cos(a), r * Sin(a), 0};
EndFor
For i In {0:3}
  Line(1 + i) = {1, 2 + 2 * i};
EndFor
For i In {0:5}
  Line(11 + i) = {2 + i, 3 + i};
EndFor
For i In {0:2}
  Curve Loop(1 + i) = {1 + i, 11 + 2 * i, 12 + 2 * i, -(2 + i)}; Plane Surface(1 + i) = {1 + i};
EndFor
Transfinite Curve {1:4, 11:16} = n + 1;
Transfinite Surface {1:3} Alternate;
If (quads == 1)
  Recombine Surface {1:3};
EndIf
Physical Surface("plate") = {1:3};
Physical Curve("below_left") = {11};       // by their normals, at -135, -45, 45 and 135 degrees
Physical Curve("below_right") = {12, 13};
Physical Curve("above_right") = {14, 15};
Physical Curve("above_left") = {16};
Physical Point("corner") = {1};
Physical Point("opposite") = {5};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
