// A plate whose size of cells is no constant: gmsh passes over what sets it from outside.
h = 0.5; // plain
DefineConstant[ a = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {a, 0, 0, h}; Point(3) = {a, a, 0, h}; Point(4) = {0, a, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Physical Surface("plate") = {1};
Physical Curve("left") = {4};
