// Quarter of the lower half of a sphere of radius R on a quarter of a block, tetrahedra graded towards the contact at the origin.
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.1 ];      // cell size at the contact
DefineConstant[ R = 10, W = 10, H = 10, fine = 0.9, growth = 0.35 ];

Sphere(1) = {0, 0, R, R, -Pi / 2, 0, Pi / 2};
Box(2) = {0, 0, -H, W, W, H};

Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * 0.5 * (abs(sqrt(x*x+y*y+z*z) - %g) + sqrt(x*x+y*y+z*z) - %g)", h, growth, fine, fine);
Background Field = 1;
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;
Mesh.Optimize = 1;

e = 1e-3;
Physical Volume("sphere") = {1};
Physical Volume("block") = {2};
sx() = Surface In BoundingBox {-e, -e, -H - e, e, R + e, R + e};
sy() = Surface In BoundingBox {-e, -e, -H - e, R + e, e, R + e};
Physical Surface("symmetry_x") = {sx()};
Physical Surface("symmetry_y") = {sy()};
top() = Surface In BoundingBox {-e, -e, R - e, R + e, R + e, R + e};
Physical Surface("sphere_top") = {top()};
bottom() = Surface In BoundingBox {-e, -e, -H - e, W + e, W + e, -H + e};
Physical Surface("block_bottom") = {bottom()};
face() = Surface In BoundingBox {-e, -e, -e, W + e, W + e, e};
Physical Surface("block_top") = {face()};
all() = Boundary { Volume{1}; };
all() -= sx(); all() -= sy(); all() -= top();
Physical Surface("sphere_surface") = {all()};
