// A roller of radius 1 between two plates, none of the meshes regular.
Mesh.ElementOrder = 1;
Point(1) = {0, 0, 0, 0.11}; Point(2) = {1, 0, 0, 0.13}; Point(3) = {0, 1, 0, 0.06}; Point(4) = {-1, 0, 0, 0.17}; Point(5) = {0, -1, 0, 0.07};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
For k In {0 : 1}
  y = k == 0 ? -2 : 1;
  p = newp;
  Point(p) = {-1.5, y, 0, 0.1}; Point(p + 1) = {1.5, y, 0, 0.12}; Point(p + 2) = {1.5, y + 1, 0, 0.11}; Point(p + 3) = {-1.5, y + 1, 0, 0.13};
  l = newl;
  Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  loop = newll; Curve Loop(loop) = {l, l + 1, l + 2, l + 3};
  s(k) = news; Plane Surface(s(k)) = {loop};
  below(k) = l; above(k) = l + 2;
EndFor
Physical Surface("roller") = {1};
Physical Surface("plates") = {s(0), s(1)};
Physical Curve("rim") = {1, 2, 3, 4};
Physical Curve("bottom") = {below(0)};
Physical Curve("lower_plate") = {above(0)};
Physical Curve("upper_plate") = {below(1)};
Physical Curve("top") = {above(1)};
