// A quarter of a square plate with a hole of radius 1, cells graded away from the hole.
DefineConstant[ n = 6, order = 1, W = 100 ];   // n: cells round the quarter of the hole
h = Pi / 2 / n;
Point(1) = {1, 0, 0}; Point(2) = {W, 0, 0}; Point(3) = {W, W, 0}; Point(4) = {0, W, 0}; Point(5) = {0, 1, 0}; Point(6) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Circle(5) = {5, 6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5}; Plane Surface(1) = {1};
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (1 + 0.75 * (sqrt(x*x+y*y) - 1))", h);
Background Field = 1;
Mesh.ElementOrder = order;
Physical Surface("plate") = {1};
Physical Curve("symmetry_y") = {1};
Physical Curve("pulled") = {2};
Physical Curve("symmetry_x") = {4};
