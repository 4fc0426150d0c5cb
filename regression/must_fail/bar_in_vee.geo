// A round bar that lies in a vee.
SetFactory("OpenCASCADE");
DefineConstant[ size = {2.5, Name "size"} order = {1, Name "order"} ];
Point(1) = {-10, -4, 0}; Point(2) = {10, -4, 0}; Point(3) = {10, 10, 0}; Point(4) = {0, 0, 0}; Point(5) = {-10, 10, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1 : 5}; Plane Surface(1) = {1};
e() = Extrude {0, 0, 12} { Surface{1}; };
Cylinder(20) = {0, 5 * Sqrt(2), 1, 0, 0, 10, 5};
Physical Volume("vee") = {e(1)};
Physical Volume("bar") = {20};
s() = Surface In BoundingBox {-10.1, -4.1, -0.1, 10.1, -3.9, 12.1}; Physical Surface("ground") = {s()};
s() = Surface In BoundingBox {-0.1, -0.1, -0.1, 10.1, 10.1, 12.1}; Physical Surface("right") = {s()};
s() = Surface In BoundingBox {-10.1, -0.1, -0.1, 0.1, 10.1, 12.1}; Physical Surface("left") = {s()};
s() = Surface In BoundingBox {-5.1, 2, 0.9, 5.1, 12.2, 11.1}; Physical Surface("skin") = {s()};
Mesh.MeshSizeMax = size; Mesh.MeshSizeMin = size;
Mesh.ElementOrder = order;
