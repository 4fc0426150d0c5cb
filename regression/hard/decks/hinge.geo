// Two cubes of one body that share an edge (a hinge), or a vertex with `apart` = 1; each between a floor and a pressed top.
DefineConstant[apart = 0, n = 2];
SetFactory("OpenCASCADE"); Mesh.MeshSizeMin = 0.5; Mesh.MeshSizeMax = 0.5;
Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {1, 1, apart, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Volume("pair") = {1, 2};
e = 1e-6;
low() = Surface In BoundingBox{-e, -e, -e, 1 + e, 1 + e, e}; high() = Surface In BoundingBox{1 - e, 1 - e, apart + 1 - e, 2 + e, 2 + e, apart + 1 + e};
Physical Surface("bottom") = {low()}; Physical Surface("top") = {high()};
