// A sixth of a ring, radii 0.3 and 1, height 0.5: the tetrahedra at the cut at 60 degrees are not those at 0.
DefineConstant[ order = 2, high = 0.5, across = 4, up = 4, round = 5 ];
to = 60 * Pi / 180;
For k In {0 : 1}
  Point(10 * k + 1) = {0, 0, k * high};
  Point(10 * k + 2) = {0.3, 0, k * high}; Point(10 * k + 3) = {1, 0, k * high};
  Point(10 * k + 4) = {Cos(to), Sin(to), k * high}; Point(10 * k + 5) = {0.3 * Cos(to), 0.3 * Sin(to), k * high};
  Line(10 * k + 1) = {10 * k + 2, 10 * k + 3}; Circle(10 * k + 2) = {10 * k + 3, 10 * k + 1, 10 * k + 4};
  Line(10 * k + 3) = {10 * k + 4, 10 * k + 5}; Circle(10 * k + 4) = {10 * k + 5, 10 * k + 1, 10 * k + 2};
  Curve Loop(k + 1) = {10 * k + 1 : 10 * k + 4}; Plane Surface(k + 1) = {k + 1};
  Transfinite Curve {10 * k + 1} = across + 1; Transfinite Curve {10 * k + 3} = across + 3;
EndFor
For k In {1 : 4}
  Line(20 + k) = {k + 1, k + 11};
  Transfinite Curve {20 + k} = up + (k > 2 ? 2 : 1);
EndFor
For k In {1 : 4}
  Curve Loop(2 + k) = {k, 20 + k % 4 + 1, -(10 + k), -(20 + k)};
  If (k % 2)
    Plane Surface(2 + k) = {2 + k};
  Else
    Surface(2 + k) = {2 + k};
  EndIf
EndFor
Surface Loop(1) = {1 : 6}; Volume(1) = {1};
Mesh.MeshSizeMax = 0.25; Mesh.ElementOrder = order;
Physical Volume("ring") = {1};
Physical Surface("foot") = {1}; Physical Surface("skin") = {2, 4, 6};
Physical Surface("from") = {3}; Physical Surface("to") = {5};
