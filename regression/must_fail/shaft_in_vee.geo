// A hollow shaft of radius R and length 1, that is a ring in the plane.
DefineConstant[ R = 10, inner = 4, n = 24 ];
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 0;
Point(1) = {0, 0, 0};
For i In {0 : 3}
  Point(2 + i) = {inner * Cos(i * Pi / 2), inner * Sin(i * Pi / 2), 0};
  Point(6 + i) = {R * Cos(i * Pi / 2), R * Sin(i * Pi / 2), 0};
EndFor
For i In {0 : 3}
  Circle(1 + i) = {2 + i, 1, 2 + (i + 1) % 4};
  Circle(5 + i) = {6 + i, 1, 6 + (i + 1) % 4};
  Line(9 + i) = {2 + i, 6 + i};
EndFor
For i In {0 : 3}
  Curve Loop(1 + i) = {1 + i, 9 + (i + 1) % 4, -(5 + i), -(9 + i)};
  Plane Surface(1 + i) = {1 + i};
EndFor
Transfinite Curve {1 : 8} = n + 1;
Transfinite Curve {9 : 12} = 5;
Transfinite Surface {1 : 4};
Recombine Surface {1 : 4};
Physical Surface("shaft") = {1 : 4};
Physical Curve("bore") = {1 : 4};
Physical Curve("rim") = {5 : 8};
