// Half of the lower half of a disc of radius R on a rectangle, to be turned round the y axis: the sphere and the block of
// hertz_sphere.geo. Cells graded towards the contact at the origin.
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.05 ];      // cell size at the contact
DefineConstant[ R = 10, W = 10, H = 10, fine = 0.9, growth = 0.25 ];

Point(1) = {0, 0, 0}; Point(2) = {R, R, 0}; Point(3) = {0, R, 0};
Circle(1) = {1, 3, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(11) = {0, -H, 0}; Point(12) = {W, -H, 0}; Point(13) = {W, 0, 0}; Point(14) = {0, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};

Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * 0.5 * (abs(sqrt(x*x+y*y) - %g) + sqrt(x*x+y*y) - %g)", h, growth, fine, fine);
Background Field = 1;
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;

Physical Surface("sphere") = {1};
Physical Surface("block") = {2};
Physical Curve("sphere_surface") = {1};
Physical Curve("sphere_top") = {2};
Physical Curve("block_top") = {13};
Physical Curve("block_bottom") = {11};
