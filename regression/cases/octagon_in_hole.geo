// An octagon with `faces` faces a flat in a ring whose hole its corners touch.
DefineConstant[faces = 1];
Point(100) = {0, 0, 0};
For i In {0:7}
  Point(i + 1) = {10 * Cos(i * Pi / 4), 10 * Sin(i * Pi / 4), 0};
  Point(i + 11) = {10 * Cos(i * Pi / 4), 10 * Sin(i * Pi / 4), 0};
  Point(i + 21) = {15 * Cos(i * Pi / 4), 15 * Sin(i * Pi / 4), 0};
EndFor
For i In {0:7}
  Line(i + 1) = {i + 1, (i + 1) % 8 + 1};
  Circle(i + 11) = {i + 11, 100, (i + 1) % 8 + 11};
  Circle(i + 21) = {i + 21, 100, (i + 1) % 8 + 21};
  Transfinite Curve {i + 1} = faces + 1; Transfinite Curve {i + 11, i + 21} = 13;
EndFor
Curve Loop(1) = {1:8}; Curve Loop(2) = {11:18}; Curve Loop(3) = {21:28};
Plane Surface(1) = {1}; Plane Surface(2) = {3, 2};
Mesh.MeshSizeMin = 0; Mesh.MeshSizeMax = 4;
Physical Surface("bar") = {1}; Physical Surface("ring") = {2};
Physical Curve("flats") = {1:8}; Physical Curve("hole") = {11:18}; Physical Curve("rim") = {21:28};
