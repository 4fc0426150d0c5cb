// Half a turn of a belt of thickness t round a drum of radius 100, n cells along it.
DefineConstant[ t = 2, n = 60 ];
R = 100;
Point(1) = {0, 0, 0}; Point(2) = {R, 0, 0}; Point(3) = {R + t, 0, 0}; Point(4) = {-R, 0, 0}; Point(5) = {-R - t, 0, 0}; Point(6) = {0, R, 0}; Point(7) = {0, R + t, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 7}; Circle(3) = {7, 1, 5}; Line(4) = {5, 4}; Circle(5) = {4, 1, 6}; Circle(6) = {6, 1, 2}; Line(7) = {6, 7};
Curve Loop(1) = {1, 2, -7, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {7, 3, 4, 5}; Plane Surface(2) = {2};
Transfinite Curve {1, 4, 7} = 3; Transfinite Curve {2, 3, 5, 6} = n / 2 + 1; Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("belt") = {1, 2}; Physical Curve("inner") = {5, 6}; Physical Curve("first") = {1}; Physical Curve("last") = {4};
