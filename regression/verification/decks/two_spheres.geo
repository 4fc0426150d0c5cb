// A quarter of the halves of two spheres of radius R that touch at the origin, tetrahedra graded towards the contact; the sides do not match.
SetFactory("OpenCASCADE");
DefineConstant[ h = 2 ];      // cell size at the contact
DefineConstant[ R = 50, fine = 13, growth = 0.3, order = 1 ];

Sphere(1) = {0, 0, R, R, -Pi / 2, 0, Pi / 2};
Sphere(2) = {0, 0, -R, R, 0, Pi / 2, Pi / 2};

Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("(1 - 0.05 * z / (abs(z) + 1e-6)) * (%g + %g * 0.5 * (abs(sqrt(x*x+y*y+z*z) - %g) + sqrt(x*x+y*y+z*z) - %g))", h, growth, fine, fine);
Background Field = 1;
Mesh.ElementOrder = order;
Mesh.Optimize = 1;

e = 1e-3;
Physical Volume("upper") = {1};
Physical Volume("lower") = {2};
sx() = Surface In BoundingBox {-e, -e, -R - e, e, R + e, R + e};
sy() = Surface In BoundingBox {-e, -e, -R - e, R + e, e, R + e};
top() = Surface In BoundingBox {-e, -e, R - e, R + e, R + e, R + e};
bottom() = Surface In BoundingBox {-e, -e, -R - e, R + e, R + e, -R + e};
Physical Surface("symmetry_x") = {sx()};
Physical Surface("symmetry_y") = {sy()};
Physical Surface("top") = {top()};
Physical Surface("bottom") = {bottom()};
upper() = Boundary { Volume{1}; };
upper() -= sx(); upper() -= sy(); upper() -= top();
lower() = Boundary { Volume{2}; };
lower() -= sx(); lower() -= sy(); lower() -= bottom();
Physical Surface("upper_surface") = {upper()};
Physical Surface("lower_surface") = {lower()};
