// Quarter of a cylinder of radius R on half of a block, plane; graded towards the contact at the origin, where the two sides do not match.
DefineConstant[ h = 0.4 ];     // cell size at the contact
DefineConstant[ R = 50, W = 200, H = 200, d = 12 ]; // d: extent of the fine region, twice the contact
hf = R / 6;

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
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;
Mesh.Algorithm = 6;
Recombine Surface {1, 11};

Physical Surface("cylinder") = {1};
Physical Surface("block") = {11};
Physical Curve("cylinder_surface") = {1};
Physical Curve("cylinder_top") = {3};
Physical Curve("block_top") = {11};
Physical Curve("block_bottom") = {14};
Physical Curve("symmetry") = {4, 5, 15, 16};
