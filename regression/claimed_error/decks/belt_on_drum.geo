// A belt of thickness t on a drum of radius R, over 90 degrees.
DefineConstant[ R = 100, t = 2, n = 60 ];
Point(1) = {0, 0, 0}; Point(2) = {R, 0, 0}; Point(3) = {R + t, 0, 0}; Point(4) = {0, R, 0}; Point(5) = {0, R + t, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 5}; Line(3) = {5, 4}; Circle(4) = {4, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 3; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("belt") = {1}; Physical Curve("inner") = {4}; Physical Curve("first") = {1}; Physical Curve("last") = {3};
