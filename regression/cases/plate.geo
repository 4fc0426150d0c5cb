// A plate with names for points and edges.
SetFactory("OpenCASCADE");
DefineConstant[ size = 2, order = 1 ];
Box(1) = {0, 0, 0, 10, 6, 4};
near = 1e-3;
Physical Volume("plate") = {1};
Physical Surface("left") = Surface In BoundingBox {-near, -near, -near, near, 6 + near, 4 + near};
Physical Surface("right") = Surface In BoundingBox {10 - near, -near, -near, 10 + near, 6 + near, 4 + near};
Physical Curve("hinge") = Curve In BoundingBox {-near, -near, -near, near, 6 + near, near};
Physical Curve("rest") = Curve In BoundingBox {-near, -near, 4 - near, near, 6 + near, 4 + near};
Physical Curve("tip") = Curve In BoundingBox {10 - near, -near, 4 - near, 10 + near, 6 + near, 4 + near};
Physical Point("origin") = Point In BoundingBox {-near, -near, -near, near, near, near};
Physical Point("along") = Point In BoundingBox {10 - near, -near, -near, 10 + near, near, near};
Physical Point("across") = Point In BoundingBox {-near, 6 - near, -near, near, 6 + near, near};
Mesh.MeshSizeMax = size;
Mesh.ElementOrder = order;
