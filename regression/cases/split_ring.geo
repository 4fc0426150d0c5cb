// A ring, radii 1 and 2, in three parts: the first cut has nodes of its own on either side.
DefineConstant[n = 6];
Point(1) = {0, 0, 0};
For k In {0:3}
  Point(2 + k) = {Cos(2 * Pi * k / 3), Sin(2 * Pi * k / 3), 0}; Point(6 + k) = {2 * Cos(2 * Pi * k / 3), 2 * Sin(2 * Pi * k / 3), 0};
  Line(1 + k) = {2 + k, 6 + k};
EndFor
For k In {0:2}
  Circle(5 + k) = {2 + k, 1, 3 + k}; Circle(9 + k) = {6 + k, 1, 7 + k};
  Curve Loop(1 + k) = {1 + k, 9 + k, -(2 + k), -(5 + k)}; Plane Surface(1 + k) = {1 + k};
EndFor
Transfinite Curve {1:4} = n + 1; Transfinite Curve {5:7, 9:11} = 4 * n + 1;
Transfinite Surface {1:3}; Recombine Surface {1:3}; Mesh.ElementOrder = 2;
Physical Surface("ring") = {1:3};
Physical Curve("bore") = {5:7}; Physical Curve("outside") = {9:11};
Physical Curve("cut") = {1}; Physical Curve("other_cut") = {4};
