// A ball with a handle in a cup of nearly its radius.
SetFactory("OpenCASCADE");
DefineConstant[ size = {2.5, Name "size"} order = {1, Name "order"} ];
Box(1) = {-8, -8, -8, 16, 16, 8};
Sphere(2) = {0, 0, 0, 5.05};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Sphere(4) = {0, 0, 0, 5};
Box(5) = {-1, -1, 0, 2, 2, 10};
BooleanUnion(6) = { Volume{4}; Delete; }{ Volume{5}; Delete; };
Physical Volume("cup") = {3};
Physical Volume("ball") = {6};
s() = Surface In BoundingBox {-5.2, -5.2, -5.2, 5.2, 5.2, 5.2}; Physical Surface("round") = {s()};  // of both
s() = Surface In BoundingBox {-8.1, -8.1, -8.1, 8.1, 8.1, -7.9}; Physical Surface("ground") = {s()};
s() = Surface In BoundingBox {-1.1, -1.1, 9.9, 1.1, 1.1, 10.1}; Physical Surface("handle") = {s()};
Mesh.MeshSizeMax = size; Mesh.MeshSizeMin = size;
Mesh.ElementOrder = order;
