// A quarter of a ring, radii 1 and 2, in a plane: its closed curve alone.
DefineConstant[ n = 8 ];   // cells through the wall
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 2, 0}; Point(5) = {0, 1, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2} = 3 * n + 1;
Transfinite Curve {4} = 2 * n + 1;
Physical Curve("foot") = {1};
Physical Curve("rim") = {2};
Physical Curve("side") = {3};
Physical Curve("bore") = {4};
