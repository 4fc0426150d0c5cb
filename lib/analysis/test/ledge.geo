// An L with a ledge at y = 1, x > 1, and an edge of 120 degrees at its foot.
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {1, 1, 0}; Point(5) = {1, 2, 0}; Point(6) = {0, 2, 0};
Point(7) = {-Tan(Pi / 6), 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7}; Plane Surface(1) = {1};
Transfinite Curve {1} = 5; Transfinite Curve {2, 3, 4, 5, 6, 7} = 3;
Physical Surface("part") = {1};
Physical Curve("ledge") = {3}; Physical Curve("foot") = {1}; Physical Curve("side") = {2}; Physical Curve("flank") = {7};
