// Half of the lower half of a disc of radius R, to be turned round the y axis. Cells graded towards the contact at the origin.
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.1 ];      // cell size at the contact
DefineConstant[ R = 30, fine = 2.4, growth = 0.25 ];
Point(1) = {0, 0, 0}; Point(2) = {R, R, 0}; Point(3) = {0, R, 0};
Circle(1) = {1, 3, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * 0.5 * (abs(sqrt(x*x+y*y) - %g) + sqrt(x*x+y*y) - %g)", h, growth, fine, fine);
Background Field = 1;
Physical Surface("sphere") = {1};
Physical Curve("surface") = {1};
Physical Curve("top") = {2};
