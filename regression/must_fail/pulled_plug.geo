// A plug in a conical seat, a section through the axis x = 0: the flank leans outwards by 0.4582.
DefineConstant[ n = 20 ];
h = 22; a = 12.8; b = a + 0.4582 * h;
Point(1) = {4, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {b, h, 0}; Point(4) = {4, h, 0};
Point(5) = {a, 0, 0}; Point(6) = {35, 0, 0}; Point(7) = {35, h, 0}; Point(8) = {b, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve{1, 3, 5, 7} = 9; Transfinite Curve{2, 4} = n + 1; Transfinite Curve{6, 8} = n + 1;
Transfinite Surface{1, 2}; Recombine Surface{1, 2};
Physical Surface("plug") = {1}; Physical Surface("seat") = {2};
Physical Curve("flank") = {2}; Physical Curve("bowl") = {8}; Physical Curve("top") = {3}; Physical Curve("bottom") = {5};
