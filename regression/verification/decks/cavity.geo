// An octant of a cube with a spherical cavity of radius 1, tetrahedra graded away from the cavity.
SetFactory("OpenCASCADE");
DefineConstant[ n = 4, order = 1, W = 10 ];   // n: cells round a quarter of the cavity
Box(1) = {0, 0, 0, W, W, W};
Sphere(2) = {0, 0, 0, 1, 0, Pi / 2, Pi / 2};
BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (1 + 0.75 * (sqrt(x*x+y*y+z*z) - 1))", Pi / 2 / n);
Background Field = 1;
Mesh.ElementOrder = order;
Mesh.Optimize = 1;
e = 1e-3;
Physical Volume("cube") = {1};
x() = Surface In BoundingBox {-e, -e, -e, e, W + e, W + e};
y() = Surface In BoundingBox {-e, -e, -e, W + e, e, W + e};
z() = Surface In BoundingBox {-e, -e, -e, W + e, W + e, e};
top() = Surface In BoundingBox {-e, -e, W - e, W + e, W + e, W + e};
Physical Surface("symmetry_x") = {x()};
Physical Surface("symmetry_y") = {y()};
Physical Surface("symmetry_z") = {z()};
Physical Surface("pulled") = {top()};
