// Two bricks with one mesh on both sides of their joint z = 1 + slope x, or merged there.
DefineConstant[merged = 0, slope = 0.4, n = 4];
For k In {0:3}
  x = (k == 1 || k == 2); y = (k > 1);
  Point(1 + k) = {x, y, 0}; Point(5 + k) = {x, y, 1 + slope * x}; Point(9 + k) = {x, y, 1 + slope * x}; Point(13 + k) = {x, y, 2.2};
EndFor
u = merged ? 5 : 9;
For k In {0:3}
  l = (k + 1) % 4;
  Line(1 + k) = {1 + k, 1 + l}; Line(5 + k) = {5 + k, 5 + l}; Line(9 + k) = {9 + k, 9 + l}; Line(13 + k) = {13 + k, 13 + l};
  Line(17 + k) = {1 + k, 5 + k}; Line(21 + k) = {u + k, 13 + k};
EndFor
For j In {0:3}
  Curve Loop(1 + j) = {1 + 4 * j:4 + 4 * j}; Plane Surface(1 + j) = {1 + j};
EndFor
For k In {0:3}
  l = (k + 1) % 4;
  Curve Loop(5 + k) = {1 + k, 17 + l, -(5 + k), -(17 + k)}; Plane Surface(5 + k) = {5 + k};
  Curve Loop(9 + k) = {u + k, 21 + l, -(13 + k), -(21 + k)}; Plane Surface(9 + k) = {9 + k};
EndFor
Surface Loop(1) = {1, 2, 5:8}; Volume(1) = {1};
Surface Loop(2) = {merged ? 2 : 3, 4, 9:12}; Volume(2) = {2};
Transfinite Curve{1:16} = n + 1; Transfinite Curve{17:24} = 3;
Transfinite Surface{1:12}; Recombine Surface{1:12}; Transfinite Volume{1, 2};
If(merged)
  Physical Volume("whole") = {1, 2};
Else
  Physical Volume("lower") = {1}; Physical Volume("upper") = {2}; Physical Surface("lower_joint") = {2}; Physical Surface("upper_joint") = {3};
EndIf
Physical Surface("foot") = {1}; Physical Surface("top") = {4}; Physical Surface("lower_side") = {8}; Physical Surface("upper_side") = {12};
