// A wedge between a base and a slider.
DefineConstant[h = 1, angle = 5];
t = Tan(angle * Pi / 180);
thick = 2 + 20 * t;
Point(1) = {0, 0, 0, h}; Point(2) = {20, 0, 0, h}; Point(3) = {20, 2, 0, h}; Point(4) = {0, thick, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
// Beyond the wedge on both sides, which slides.
Point(11) = {-3, -5, 0, h}; Point(12) = {23, -5, 0, h}; Point(13) = {23, 0, 0, h}; Point(14) = {-3, 0, 0, h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Point(21) = {23, 2 - 3 * t, 0, h}; Point(22) = {23, thick + 6, 0, h}; Point(23) = {-3, thick + 6, 0, h}; Point(24) = {-3, thick + 3 * t, 0, h};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
Curve Loop(3) = {21, 22, 23, 24}; Plane Surface(3) = {3};
Recombine Surface {:};
Physical Surface("wedge") = {1}; Physical Surface("base") = {2}; Physical Surface("slider") = {3};
Physical Curve("sole") = {1}; Physical Curve("slope") = {3}; Physical Curve("back") = {4};
Physical Curve("floor") = {13}; Physical Curve("slide") = {24}; Physical Curve("ground") = {11}; Physical Curve("top") = {22};
