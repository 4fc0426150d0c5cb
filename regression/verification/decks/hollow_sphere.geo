// An octant of a hollow sphere, radii 1 and 2, unstructured tetrahedra.
SetFactory("OpenCASCADE");
DefineConstant[ n = 4, order = 1 ];
Sphere(1) = {0, 0, 0, 2, 0, Pi / 2, Pi / 2};
Sphere(2) = {0, 0, 0, 1, 0, Pi / 2, Pi / 2};
BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeMin = 1 / n; Mesh.MeshSizeMax = 1 / n;
Mesh.ElementOrder = order;
Mesh.Optimize = 1;
e = 1e-3;
Physical Volume("sphere") = {1};
x() = Surface In BoundingBox {-e, -e, -e, e, 2 + e, 2 + e};
y() = Surface In BoundingBox {-e, -e, -e, 2 + e, e, 2 + e};
z() = Surface In BoundingBox {-e, -e, -e, 2 + e, 2 + e, e};
bore() = Surface In BoundingBox {-e, -e, -e, 1 + e, 1 + e, 1 + e};
Physical Surface("symmetry_x") = {x()};
Physical Surface("symmetry_y") = {y()};
Physical Surface("symmetry_z") = {z()};
Physical Surface("bore") = {bore()};
