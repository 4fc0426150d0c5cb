// A sector of 2 degrees of a ring, radii 1 and 2.
DefineConstant[ n = 30 ];   // cells across the ring
from = 20 * Pi / 180; to = 22 * Pi / 180;
Point(1) = {0, 0, 0};
Point(2) = {Cos(from), Sin(from), 0}; Point(3) = {2 * Cos(from), 2 * Sin(from), 0};
Point(4) = {2 * Cos(to), 2 * Sin(to), 0}; Point(5) = {Cos(to), Sin(to), 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, -3} = n + 1; Transfinite Curve {2, 4} = 2;
Transfinite Surface {1}; Recombine Surface {1};
Mesh.ElementOrder = 2;
Physical Surface("ring") = {1};
Physical Curve("cut_a") = {1};
Physical Curve("cut_b") = {3};
Physical Curve("rim") = {2};
Physical Curve("bore") = {4};
