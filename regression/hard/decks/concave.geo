// Four quadrilaterals whose common node was dragged out of the middle: with shift > 0.5 one is concave, and its map turns inside out.
DefineConstant[shift = 0.7];
Mesh.RecombineAll = 1;
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 1, 0}; Point(5) = {1 + shift, 1 + shift, 0};
Point(6) = {2, 1, 0}; Point(7) = {0, 2, 0}; Point(8) = {1, 2, 0}; Point(9) = {2, 2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {4, 5}; Line(4) = {5, 6}; Line(5) = {7, 8}; Line(6) = {8, 9};
Line(7) = {1, 4}; Line(8) = {4, 7}; Line(9) = {2, 5}; Line(10) = {5, 8}; Line(11) = {3, 6}; Line(12) = {6, 9};
Curve Loop(1) = {1, 9, -3, -7}; Curve Loop(2) = {2, 11, -4, -9}; Curve Loop(3) = {3, 10, -5, -8}; Curve Loop(4) = {4, 12, -6, -10};
Plane Surface(1) = {1}; Plane Surface(2) = {2}; Plane Surface(3) = {3}; Plane Surface(4) = {4};
Transfinite Curve{1 : 12} = 2; Transfinite Surface{1 : 4};
Physical Surface("patch") = {1 : 4}; Physical Curve("bottom") = {1, 2}; Physical Curve("top") = {5, 6};
