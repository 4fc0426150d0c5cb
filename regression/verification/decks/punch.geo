// Half of a punch on half of a large block. R = 0: flat, half width 1. Else flat for x < b and rounded by R beyond.
DefineConstant[ h = 0.1 ];     // cell size at the contact
DefineConstant[ R = 0, b = 0.5, W = 60, T = 0.5, order = 1 ];
Point(1) = {0, 0, 0, h};
If (R == 0)
  Point(2) = {1, 0, 0, h}; Point(3) = {1, T, 0, 2 * h}; Point(4) = {0, T, 0, 2 * h};
  Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
  Curve Loop(1) = {1, 2, 3, 4};
  under() = {1};
  Transfinite Curve {1} = Ceil(1 / h) + 1;
Else
  w = 0.6; s = w / R;
  Point(2) = {b, 0, 0, h}; Point(5) = {b, R, 0}; Point(6) = {b + R * Sin(s), R * (1 - Cos(s)), 0, h};
  Point(3) = {b + R * Sin(s), T, 0, 2 * h}; Point(4) = {0, T, 0, 2 * h};
  Line(1) = {1, 2}; Circle(5) = {2, 5, 6}; Line(2) = {6, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
  Curve Loop(1) = {1, 5, 2, 3, 4};
  under() = {1, 5};
  Transfinite Curve {1} = Ceil(b / h) + 1; Transfinite Curve {5} = Ceil(w / h) + 1;
EndIf
Plane Surface(1) = {1};
d = 1.2;
Point(11) = {0, 0, 0, h}; Point(12) = {d, 0, 0, h}; Point(13) = {W, 0, 0, W / 8}; Point(14) = {W, -W, 0, W / 8}; Point(15) = {0, -W, 0, W / 8};
Point(16) = {0, -d, 0, 3 * h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11};
Curve Loop(11) = {-11, -16, -15, -14, -13, -12}; Plane Surface(11) = {11};
Transfinite Curve {11} = Ceil(1.25 * d / h) + 1;
Mesh.ElementOrder = order;
Mesh.Algorithm = 6;
Recombine Surface {1, 11};
Physical Surface("punch") = {1};
Physical Surface("block") = {11};
Physical Curve("punch_face") = {under()};
Physical Curve("punch_top") = {3};
Physical Curve("block_top") = {11};
Physical Curve("block_bottom") = {14};
Physical Curve("symmetry") = {4, 15, 16};
