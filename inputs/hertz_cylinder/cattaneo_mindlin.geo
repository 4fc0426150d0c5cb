// Lower half of a cylinder of radius R on a block, plane, both halves; graded towards the contact.
DefineConstant[ h = 0.1 ];     // cell size at the contact
DefineConstant[ R = 50, W = 100, H = 100 ];
d = 4;                         // half the extent of the fine region
hf = R / 5;

Point(1) = {-R * Sin(d / R), R - R * Cos(d / R), 0, h}; Point(2) = {R * Sin(d / R), R - R * Cos(d / R), 0, h};
Point(3) = {R, R, 0, hf}; Point(4) = {0, R, 0, hf}; Point(5) = {-R, R, 0, hf}; Point(6) = {0, 0, 0, h};
Circle(1) = {1, 4, 6}; Circle(2) = {6, 4, 2}; Circle(3) = {2, 4, 3}; Line(4) = {3, 5}; Circle(5) = {5, 4, 1};
Curve Loop(1) = {1, 2, 3, 4, 5}; Plane Surface(1) = {1};

Point(11) = {-d, 0, 0, h}; Point(12) = {d, 0, 0, h}; Point(13) = {W, 0, 0, W / 5}; Point(14) = {W, -H, 0, W / 5};
Point(15) = {-W, -H, 0, W / 5}; Point(16) = {-W, 0, 0, W / 5};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11};
Curve Loop(11) = {-11, -16, -15, -14, -13, -12}; Plane Surface(11) = {11};

Transfinite Curve {1, 2} = Ceil(d / h) + 1;
Transfinite Curve {11} = Ceil(1.6 * d / h) + 1;
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;
Mesh.Algorithm = 6;
Recombine Surface {1, 11};

Physical Surface("cylinder") = {1};
Physical Surface("block") = {11};
Physical Curve("cylinder_surface") = {1, 2};
Physical Curve("cylinder_top") = {4};
Physical Curve("block_top") = {11};
Physical Curve("block_bottom") = {14};
