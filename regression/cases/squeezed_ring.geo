// A ring of round section between a pin and a cylinder, and a wall below it: half planes of bodies of revolution about y.
DefineConstant[ n = 16 ];  // cells on a quarter of the section
Point(1) = {10, 0, 0};
For k In {0:3}
  Point(2 + k) = {10 + Cos(k * Pi / 2), Sin(k * Pi / 2), 0};
EndFor
For k In {0:3}
  Circle(1 + k) = {2 + k, 1, 2 + (k + 1) % 4};
EndFor
Transfinite Curve{1:4} = n + 1;
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
x0[] = {8.5, 11, 9.3};
x1[] = {9, 11.5, 10.7};
y0[] = {-1.2, -1.2, -1.4};
y1[] = {1.2, 1.2, -1.1};
For k In {0:2}
  p = newp;
  Point(p) = {x0[k], y0[k], 0};
  Point(p + 1) = {x1[k], y0[k], 0};
  Point(p + 2) = {x1[k], y1[k], 0};
  Point(p + 3) = {x0[k], y1[k], 0};
  c = 10 + 10 * k;
  For i In {0:3}
    Line(c + i) = {p + i, p + (i + 1) % 4};
  EndFor
  Curve Loop(2 + k) = {c : c + 3};
  Plane Surface(2 + k) = {2 + k};
EndFor
Mesh.MeshSizeMin = 0.2;
Mesh.MeshSizeMax = 0.2;
Physical Surface("ring") = {1};
Physical Surface("pin") = {2};
Physical Surface("cylinder") = {3};
Physical Surface("wall") = {4};
Physical Curve("round") = {1:4};
Physical Curve("pin_face") = {11};
Physical Curve("pin_back") = {13};
Physical Curve("cylinder_face") = {23};
Physical Curve("cylinder_back") = {21};
Physical Curve("wall_face") = {32};
Physical Curve("wall_back") = {30};
