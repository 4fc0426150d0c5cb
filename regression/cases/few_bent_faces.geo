// A hollow pin in a ring, `faces` faces round each, turned against each other.
DefineConstant[faces = 8];
Point(100) = {0, 0, 0};
For c In {0:3}
  r = (c == 0) ? 1 : (c == 1) ? 3 : (c == 2) ? 3.05 : 6;
  a = (c < 2) ? 0.2 : 0;
  For i In {0:3}
    Point(10 * c + i + 1) = {r * Cos(a + i * Pi / 2), r * Sin(a + i * Pi / 2), 0};
  EndFor
  For i In {0:3}
    Circle(10 * c + i + 1) = {10 * c + i + 1, 100, 10 * c + (i + 1) % 4 + 1};
    Transfinite Curve {10 * c + i + 1} = faces / 4 + 1;
  EndFor
  Curve Loop(c + 1) = {10 * c + 1:10 * c + 4};
EndFor
Plane Surface(1) = {2, 1}; Plane Surface(2) = {4, 3};
Mesh.MeshSizeMin = 0; Mesh.MeshSizeMax = 4;
Physical Surface("pin") = {1}; Physical Surface("ring") = {2};
Physical Curve("core") = {1:4}; Physical Curve("shank") = {11:14}; Physical Curve("hole") = {21:24}; Physical Curve("rim") = {31:34};
