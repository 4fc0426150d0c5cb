// An eighth of a thick hollow sphere, radii 1 and 2.
SetFactory("OpenCASCADE");
DefineConstant[size = 0.18];
Sphere(1) = {0, 0, 0, 2, 0, Pi / 2, Pi / 2};
Sphere(2) = {0, 0, 0, 1};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
e = 1e-3;
Physical Volume("ball") = {3};
Physical Surface("x") = Surface In BoundingBox{-e, -e, -e, e, 2 + e, 2 + e};
Physical Surface("y") = Surface In BoundingBox{-e, -e, -e, 2 + e, e, 2 + e};
Physical Surface("z") = Surface In BoundingBox{-e, -e, -e, 2 + e, 2 + e, e};
Physical Surface("bore") = Surface In BoundingBox{-e, -e, -e, 1 + e, 1 + e, 1 + e};
Mesh.MeshSizeMax = size;
