// A plate with a hole on a pin that sticks out of it.
SetFactory("OpenCASCADE");
DefineConstant[ size = {5, Name "size"} order = {1, Name "order"} clearance = {0.05, Name "clearance"} ];
Box(1) = {-30, -20, -5, 60, 40, 10};
Cylinder(2) = {0, 0, -6, 0, 0, 12, 10 + clearance};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0, 0, -12, 0, 0, 24, 10};
Physical Volume("plate") = {3};
Physical Volume("pin") = {4};
s() = Surface In BoundingBox {-10.5, -10.5, -5.5, 10.5, 10.5, 5.5}; Physical Surface("hole") = {s()};
s() = Surface In BoundingBox {-10.1, -10.1, -12.1, 10.1, 10.1, -11.9}; Physical Surface("foot") = {s()};
s() = Surface In BoundingBox {29.9, -20.1, -5.1, 30.1, 20.1, 5.1}; Physical Surface("end") = {s()};
s() = Abs(Boundary{ Volume{4}; }); Physical Surface("shaft") = {s()};
Mesh.MeshSizeMax = size; Mesh.MeshSizeMin = size;
Mesh.ElementOrder = order;
