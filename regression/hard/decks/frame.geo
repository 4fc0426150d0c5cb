// A frame of thin struts, one cell wide, on the ground: METIS cuts it into subdomains that hang on two nodes.
SetFactory("OpenCASCADE"); Mesh.ElementOrder = 1; Mesh.MeshSizeMin = 0.2; Mesh.MeshSizeMax = 0.2;
Rectangle(1) = {0, 0, 0, 4, 0.2}; Rectangle(2) = {0, 2, 0, 4, 0.2};
Rectangle(3) = {0, 0, 0, 0.2, 2.2}; Rectangle(4) = {1.2, 0, 0, 0.2, 2.2}; Rectangle(5) = {2.4, 0, 0, 0.2, 2.2}; Rectangle(6) = {3.8, 0, 0, 0.2, 2.2};
BooleanFragments{ Surface{1 : 6}; Delete; }{}
frame() = Surface In BoundingBox{-1, -0.001, -1, 5, 3, 1};
Rectangle(200) = {0, -1, 0, 4, 1};
Physical Surface("frame") = {frame()}; Physical Surface("ground") = {200};
Physical Curve("top") = Curve In BoundingBox{-0.001, 2.199, -1, 4.001, 2.201, 1};
Physical Curve("feet") = Curve In BoundingBox{-0.001, -0.0005, -1, 4.001, 0.0005, 1};
bottom() = Boundary{ Surface{200}; };
Physical Curve("base") = {Abs(bottom(0))}; Physical Curve("face") = {Abs(bottom(2))};
