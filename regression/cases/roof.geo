// A sled on a roof with flanks of 15 degrees, meshes that do not match; mm.
rise = 10 * Tan(Pi / 12); n = 10;
Point(1) = {-10, 0, 0}; Point(2) = {0, rise, 0}; Point(3) = {10, 0, 0}; Point(4) = {10, -8, 0}; Point(5) = {0, -8, 0}; Point(6) = {-10, -8, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Point(11) = {-10, 0, 0}; Point(12) = {0, rise, 0}; Point(13) = {10, 0, 0}; Point(14) = {10, 12, 0}; Point(15) = {0, 12, 0}; Point(16) = {-10, 12, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11}; Line(17) = {12, 15};
Curve Loop(3) = {11, 17, 15, 16}; Plane Surface(3) = {3}; Curve Loop(4) = {12, 13, 14, -17}; Plane Surface(4) = {4};
Transfinite Curve {1, 2, 4, 5} = n + 1; Transfinite Curve {3, 6, 7} = 9;
Transfinite Curve {11, 12, 14, 15} = n + 2; Transfinite Curve {13, 16, 17} = 9;
Transfinite Surface {1:4}; Recombine Surface {1:4};
Physical Surface("bed") = {1, 2}; Physical Surface("sled") = {3, 4};
Physical Curve("base") = {4, 5}; Physical Curve("top") = {14, 15};
Physical Curve("roof") = {1, 2}; Physical Curve("left_flank") = {1}; Physical Curve("right_flank") = {2};
Physical Curve("below") = {11, 12}; Physical Curve("below_left") = {11}; Physical Curve("below_right") = {12};
