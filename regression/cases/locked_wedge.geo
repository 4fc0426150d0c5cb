// A wedge, narrower below, between two jaws.
DefineConstant[h = 1, angle = 2];
t = Tan(angle * Pi / 180);
Point(1) = {-8, 0, 0, h}; Point(2) = {8, 0, 0, h}; Point(3) = {8 + 20 * t, 20, 0, h}; Point(4) = {-8 - 20 * t, 20, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(11) = {8 + 2 * t, 2, 0, h}; Point(12) = {30, 2, 0, h}; Point(13) = {30, 16, 0, h}; Point(14) = {8 + 16 * t, 16, 0, h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Point(21) = {-8 - 16 * t, 16, 0, h}; Point(22) = {-30, 16, 0, h}; Point(23) = {-30, 2, 0, h}; Point(24) = {-8 - 2 * t, 2, 0, h};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
Curve Loop(3) = {21, 22, 23, 24}; Plane Surface(3) = {3};
Physical Surface("wedge") = {1}; Physical Surface("right") = {2}; Physical Surface("left") = {3};
Physical Curve("right_flank") = {2}; Physical Curve("head") = {3}; Physical Curve("left_flank") = {4};
Physical Curve("right_jaw") = {14}; Physical Curve("right_back") = {12}; Physical Curve("left_jaw") = {24}; Physical Curve("left_back") = {22};
