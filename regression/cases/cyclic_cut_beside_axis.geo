// A sector of 30 degrees of a ring; a cut lies off the y axis by what is hardly more than nothing.
DefineConstant[ off = 1.22e-6 ];
first = Pi / 3 + off; last = Pi / 2 + off;
Point(1) = {Cos(first), Sin(first), 0}; Point(2) = {2 * Cos(first), 2 * Sin(first), 0};
Point(3) = {2 * Cos(last), 2 * Sin(last), 0}; Point(4) = {Cos(last), Sin(last), 0}; Point(5) = {0, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 5, 3}; Line(3) = {3, 4}; Circle(4) = {4, 5, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 9; Transfinite Curve {2, 4} = 7; Transfinite Surface {1}; Recombine Surface {1};
Mesh.SecondOrderIncomplete = 1;
Physical Surface("ring") = {1};
Physical Curve("cut_a") = {1}; Physical Curve("cut_b") = {3}; Physical Curve("rim") = {2}; Physical Curve("bore") = {4};
