// A sector of 30 degrees of a tube in the plane, 5..10.
c = Cos(Pi / 6); s = Sin(Pi / 6);
Point(1) = {0, 0, 0};
Point(2) = {5, 0, 0}; Point(3) = {10, 0, 0}; Point(4) = {10 * c, 10 * s, 0}; Point(5) = {5 * c, 5 * s, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 4; Transfinite Curve {2, 4} = 3;
Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("tube") = {1};
Physical Curve("bore") = {4}; Physical Curve("mantle") = {2}; Physical Curve("low") = {1}; Physical Curve("high") = {3};
