// A plug between two planes that lean 10 degrees outwards, structured quadrilaterals.
h = 20; a = 10; t = Tan(10 * Pi / 180); n = 8;
Point(1) = {-a, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {a + h * t, h, 0}; Point(4) = {-a - h * t, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = n + 1; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("plug") = {1}; Physical Curve("left") = {4}; Physical Curve("right") = {2}; Physical Curve("top") = {3};
