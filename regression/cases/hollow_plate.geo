// A plate that is hollow below by `rise`, 20 wide, 6 thick, on a wider one: right half of both, W long (0: the cross-section); mm.
DefineConstant[ W = {8, Name "length"}, rise = {0.4, Name "rise"}, N = {9, Name "cells across"}, NZ = {2, Name "along"} ];
R = (100 + rise^2) / (2 * rise);
Point(1) = {0, rise, 0}; Point(2) = {10, 0, 0}; Point(3) = {10, 6, 0}; Point(4) = {0, 6, 0}; Point(5) = {0, rise - R, 0};
Circle(1) = {1, 5, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Point(11) = {0, -3, 0}; Point(12) = {12.4, -3, 0}; Point(13) = {12.4, 0, 0}; Point(14) = {0, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Curve Loop(2) = {11 : 14}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = N + 1; Transfinite Curve {2, 4} = 4;
Transfinite Curve {11, 13} = N + 1; Transfinite Curve {12, 14} = 4;
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
If (W > 0)
  a[] = Extrude {0, 0, W} { Surface{1}; Layers{NZ}; Recombine; };
  b[] = Extrude {0, 0, W} { Surface{2}; Layers{NZ}; Recombine; };
  Physical Volume("plate") = {a[1]}; Physical Volume("base") = {b[1]};
  Physical Surface("hollow") = {a[2]}; Physical Surface("top") = {a[4]}; Physical Surface("plate_middle") = {a[5]};
  Physical Surface("floor") = {b[2]}; Physical Surface("base_top") = {b[4]}; Physical Surface("base_middle") = {b[5]};
  Physical Surface("ends") = {1, 2, a[0], b[0]};
Else
  Physical Surface("plate") = {1}; Physical Surface("base") = {2};
  Physical Curve("hollow") = {1}; Physical Curve("top") = {3}; Physical Curve("plate_middle") = {4};
  Physical Curve("floor") = {11}; Physical Curve("base_top") = {13}; Physical Curve("base_middle") = {14};
EndIf
