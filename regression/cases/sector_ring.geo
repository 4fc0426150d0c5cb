// A sector of a ring, radii 1 and 2, from 20 to 50 degrees.
DefineConstant[ n = 4 ];   // cells across the ring
a = 1; b = 2; from = 20 * Pi / 180; to = 50 * Pi / 180;
Point(1) = {0, 0, 0};
Point(2) = {a * Cos(from), a * Sin(from), 0}; Point(3) = {b * Cos(from), b * Sin(from), 0};
Point(4) = {b * Cos(to), b * Sin(to), 0}; Point(5) = {a * Cos(to), a * Sin(to), 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = n + 1;
Transfinite Surface {1}; Recombine Surface {1};
Mesh.ElementOrder = 2;
Physical Surface("ring") = {1};
Physical Curve("cut_1") = {1};
Physical Curve("cut_2") = {3};
Physical Curve("bore") = {4};
Physical Curve("outside") = {2};
