// A round pin in a hole of `flats` flats, with `faces` faces each, which it touches in their middles.
DefineConstant[faces = 1, flats = 12];
r = 10 * Cos(Pi / 12); corner = r / Cos(Pi / flats);
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
For i In {0:flats - 1}
  Point(i + 11) = {corner * Cos((i + 0.5) * 2 * Pi / flats), corner * Sin((i + 0.5) * 2 * Pi / flats), 0};
EndFor
For i In {0:flats - 1}
  Line(i + 11) = {i + 11, (i + 1) % flats + 11};
  Transfinite Curve {i + 11} = faces + 1;
EndFor
Curve Loop(1) = {1:4}; Curve Loop(2) = {11:10 + flats}; Curve Loop(3) = {41:44};
Plane Surface(1) = {1}; Plane Surface(2) = {3, 2};
Mesh.MeshSizeMax = 3;
Physical Surface("pin") = {1}; Physical Surface("ring") = {2};
Physical Curve("round") = {1:4}; Physical Curve("flats") = {11:10 + flats}; Physical Curve("rim") = {41:44};
