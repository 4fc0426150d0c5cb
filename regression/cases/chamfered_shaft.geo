// A shaft of radius 10 with a chamfer of DEG degrees at its end, inside a hub; N, mm.
DefineConstant[ DEG = {15, Name "chamfer"} ];
run = 3 * Tan(DEG * Pi / 180);
Point(1) = {0, -5, 0}; Point(2) = {10, -5, 0}; Point(3) = {10, 10, 0}; Point(4) = {10 - run, 13, 0}; Point(5) = {0, 13, 0}; Point(6) = {0, 10, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {3, 6};
Curve Loop(1) = {1, 2, 7, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, -7}; Plane Surface(2) = {2};
Point(11) = {10, 0, 0}; Point(12) = {20, 0, 0}; Point(13) = {20, 20, 0}; Point(14) = {10, 20, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
Transfinite Curve {1, 7, 4, 11, 13} = 11; Transfinite Curve {2, 6} = 16; Transfinite Curve {3, 5} = 4; Transfinite Curve {12, 14} = 20;
Transfinite Surface {1, 2, 3}; Recombine Surface {1, 2, 3};
Physical Surface("shaft") = {1, 2}; Physical Surface("hub") = {3};
Physical Curve("outside") = {2, 3}; Physical Curve("bore") = {14}; Physical Curve("shaft_end") = {1}; Physical Curve("hub_end") = {11};
