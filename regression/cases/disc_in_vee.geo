// A disc of radius 5, each sixth of which begins with a node.
DefineConstant[ h = 1.7 ];
Point(1) = {0, 0, 0, h};
For k In {0 : 5}
  Point(2 + k) = {5 * Cos(k * Pi / 3), 5 * Sin(k * Pi / 3), 0, h};
EndFor
For k In {0 : 5}
  Circle(1 + k) = {2 + k, 1, 2 + (k + 1) % 6};
EndFor
Curve Loop(1) = {1 : 6};
Plane Surface(1) = {1};
Recombine Surface {1};
Physical Surface("disc") = {1};
Physical Curve("rim") = {1 : 6};
