// A round pin in a hole of twelve flats, with `faces` faces each, which it touches in their middles.
DefineConstant[faces = 1];
r = 10 * Cos(Pi / 12);
Point(100) = {0, 0, 0};
For i In {0:3}
  Point(i + 1) = {r * Cos(i * Pi / 2), r * Sin(i * Pi / 2), 0};
  Point(i + 41) = {15 * Cos(i * Pi / 2), 15 * Sin(i * Pi / 2), 0};
EndFor
For i In {0:3}
  Circle(i + 1) = {i + 1, 100, (i + 1) % 4 + 1};
  Circle(i + 41) = {i + 41, 100, (i + 1) % 4 + 41};
  Transfinite Curve {i + 1} = 19; Transfinite Curve {i + 41} = 13;
EndFor
For i In {0:11}
  Point(i + 11) = {10 * Cos((i + 0.5) * Pi / 6), 10 * Sin((i + 0.5) * Pi / 6), 0};
EndFor
For i In {0:11}
  Line(i + 11) = {i + 11, (i + 1) % 12 + 11};
  Transfinite Curve {i + 11} = faces + 1;
EndFor
Curve Loop(1) = {1:4}; Curve Loop(2) = {11:22}; Curve Loop(3) = {41:44};
Plane Surface(1) = {1}; Plane Surface(2) = {3, 2};
Mesh.MeshSizeMax = 3;
Physical Surface("pin") = {1}; Physical Surface("ring") = {2};
Physical Curve("round") = {1:4}; Physical Curve("flats") = {11:22}; Physical Curve("rim") = {41:44};
