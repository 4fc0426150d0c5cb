// Quarter of a roller of radius R on half of a plate that nothing else holds up; graded towards the contact at the origin.
DefineConstant[ h = 0.1 ];     // cell size at the contact
DefineConstant[ R = 50, W = 50, H = 50, d = 2, order = 1 ];
hf = R / 10;

Point(1) = {0, 0, 0, h}; Point(2) = {R * Sin(d / R), R - R * Cos(d / R), 0, h};
Point(3) = {R, R, 0, hf}; Point(4) = {0, R, 0, hf}; Point(5) = {0, d, 0, 3 * h};
Circle(1) = {1, 4, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5}; Plane Surface(1) = {1};

Point(11) = {0, 0, 0, h}; Point(12) = {d, 0, 0, h}; Point(13) = {W, 0, 0, W / 8}; Point(14) = {W, -H, 0, W / 8};
Point(15) = {0, -H, 0, W / 8}; Point(16) = {0, -d, 0, 3 * h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11};
Curve Loop(11) = {-11, -16, -15, -14, -13, -12}; Plane Surface(11) = {11};

Transfinite Curve {1} = Ceil(d / h) + 1;
Transfinite Curve {11} = Ceil(0.8 * d / h) + 1;
Mesh.ElementOrder = order;
Mesh.Algorithm = 6;
Recombine Surface {1, 11};

Physical Surface("roller") = {1};
Physical Surface("plate") = {11};
Physical Curve("roller_surface") = {1};
Physical Curve("middle") = {3};
Physical Curve("plate_top") = {11};
Physical Curve("plate_bottom") = {14};
Physical Curve("symmetry") = {4, 5, 15, 16};
