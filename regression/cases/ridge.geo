// A block with a ridge of DEG degrees on each side below one with a flat side; the ridge is in the middle of a face of the flat one.
DefineConstant[ DEG = {8, Name "angle"} ];
drop = 0.5 * Tan(DEG * Pi / 180);
Point(1) = {0, -0.6, 0}; Point(2) = {1, -0.6, 0}; Point(3) = {1, -drop, 0}; Point(4) = {0.5, 0, 0}; Point(5) = {0, -drop, 0}; Point(6) = {0.5, -0.6, 0};
Line(1) = {1, 6}; Line(2) = {6, 2}; Line(3) = {2, 3}; Line(4) = {3, 4}; Line(5) = {4, 5}; Line(6) = {5, 1}; Line(7) = {6, 4};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Point(11) = {0, 0, 0}; Point(12) = {1, 0, 0}; Point(13) = {1, 0.6, 0}; Point(14) = {0, 0.6, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
DefineConstant[ faces = {5, Name "faces"} ];
Transfinite Curve {1, 2, 3, 4, 5, 6, 7, 12, 14} = 4; Transfinite Curve {11, 13} = faces + 1;
Transfinite Surface {1:3}; Recombine Surface {1:3};
Physical Surface("low") = {1, 2}; Physical Surface("high") = {3};
Physical Curve("base") = {1, 2}; Physical Curve("ridge") = {4, 5}; Physical Curve("flat") = {11}; Physical Curve("top") = {13};
