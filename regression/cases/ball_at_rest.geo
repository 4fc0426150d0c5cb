// A ball in a half spherical cup of its radius: turned about its centre it is the same, but for its facets.
SetFactory("OpenCASCADE");
DefineConstant[ size = {2, Name "size"} order = {1, Name "order"} ];
Box(1) = {-8, -8, -9, 16, 16, 9};
Sphere(2) = {0, 0, 0, 5};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Sphere(4) = {0, 0, 0, 5};
Physical Volume("cup") = {3};
Physical Volume("ball") = {4};
s() = Boundary{ Volume{4}; }; Physical Surface("round") = {s()};
b() = Surface In BoundingBox {-5.2, -5.2, -5.2, 5.2, 5.2, 0.01}; b() -= s(); Physical Surface("bowl") = {b()};
Physical Surface("ground") = Surface In BoundingBox {-9, -9, -9.01, 9, 9, -8.99};
Mesh.MeshSizeMax = size;
Mesh.ElementOrder = order;
