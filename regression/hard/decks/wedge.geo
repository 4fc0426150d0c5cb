// A wedge of half angle `angle` (degrees) between two blocks with inclined faces, apex down; `gap` opens it horizontally.
DefineConstant[angle = 10, h = 0.1, shift = 0];
t = Tan(angle * Pi / 180);
Mesh.ElementOrder = 1; Mesh.RecombineAll = 1;
y0 = 1; y1 = 2;  // the wedge's height; it is 2 y t wide at height y
Point(1) = {-y0 * t, y0, 0}; Point(2) = {y0 * t, y0, 0}; Point(3) = {y1 * t, y1, 0}; Point(4) = {-y1 * t, y1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
a0 = 0.5; a1 = 2.5; w = 2;
Point(11) = {a0 * t - shift, a0, 0}; Point(12) = {w, a0, 0}; Point(13) = {w, a1, 0}; Point(14) = {a1 * t - shift, a1, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Point(21) = {-a0 * t + shift, a0, 0}; Point(22) = {-w, a0, 0}; Point(23) = {-w, a1, 0}; Point(24) = {-a1 * t + shift, a1, 0};
Line(21) = {22, 21}; Line(22) = {21, 24}; Line(23) = {24, 23}; Line(24) = {23, 22};
Curve Loop(3) = {21, 22, 23, 24}; Plane Surface(3) = {3};
Transfinite Surface{1, 2, 3};
Transfinite Curve{1, 3} = 5; Transfinite Curve{2, 4} = Round(1 / h) + 1;
Transfinite Curve{11, 13, 21, 23} = Round(1.5 / h) + 1; Transfinite Curve{12, 14, 22, 24} = Round(2 / h) + 1;
Physical Surface("wedge") = {1}; Physical Surface("right") = {2}; Physical Surface("left") = {3};
Physical Curve("top") = {3}; Physical Curve("bottom") = {1}; Physical Curve("wedge_right") = {2}; Physical Curve("wedge_left") = {4};
Physical Curve("right_wall") = {12}; Physical Curve("left_wall") = {24}; Physical Curve("right_face") = {14}; Physical Curve("left_face") = {22};
