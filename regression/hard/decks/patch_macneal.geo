// The patch of MacNeal and Harder (Finite Elem. Anal. Des. 1 (1985) 3): a box of 0.24 x 0.12 of five distorted squares, pressed onto another below
// that is meshed regularly; twice, with cells of aspect 1000 in the lower one.
Mesh.RecombineAll = 1; Mesh.ElementOrder = 1;
DefineConstant[order = 1]; Mesh.ElementOrder = order;
Point(1) = {0, 0, 0}; Point(2) = {0.24, 0, 0}; Point(3) = {0.24, 0.12, 0}; Point(4) = {0, 0.12, 0};
Point(5) = {0.04, 0.02, 0}; Point(6) = {0.18, 0.03, 0}; Point(7) = {0.16, 0.08, 0}; Point(8) = {0.08, 0.08, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Line(9) = {1, 5}; Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};
Curve Loop(1) = {1, 10, -5, -9}; Curve Loop(2) = {2, 11, -6, -10}; Curve Loop(3) = {3, 12, -7, -11}; Curve Loop(4) = {4, 9, -8, -12}; Curve Loop(5) = {5, 6, 7, 8};
Plane Surface(1) = {1}; Plane Surface(2) = {2}; Plane Surface(3) = {3}; Plane Surface(4) = {4}; Plane Surface(5) = {5};
Point(11) = {0, -0.00012, 0}; Point(12) = {0.24, -0.00012, 0}; Point(13) = {0.24, 0, 0}; Point(14) = {0, 0, 0};
Line(21) = {11, 12}; Line(22) = {12, 13}; Line(23) = {13, 14}; Line(24) = {14, 11}; Curve Loop(6) = {21, 22, 23, 24}; Plane Surface(6) = {6};
Transfinite Curve{1 : 12} = 2; Transfinite Curve{21, 23} = 3; Transfinite Curve{22, 24} = 2;
Transfinite Surface{1 : 6};
Physical Surface("patch") = {1 : 5}; Physical Surface("sheet") = {6};
Physical Curve("patch_bottom") = {1}; Physical Curve("patch_top") = {3}; Physical Curve("patch_left") = {4}; Physical Curve("sheet_top") = {23}; Physical Curve("sheet_bottom") = {21}; Physical Curve("sheet_left") = {24};
