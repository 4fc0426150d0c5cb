// A ball in a socket of its own radius; tetrahedra.
SetFactory("OpenCASCADE");
DefineConstant[ order = 1, r = 10 ];
Sphere(1) = {0, 0, 0, r};
Box(2) = {-15, -15, -15, 30, 30, 15};
Sphere(3) = {0, 0, 0, r};
BooleanDifference(4) = {Volume{2}; Delete;}{Volume{3}; Delete;};
MeshSize{:} = 6;
MeshSize{PointsOf{Volume{1};}} = 5;
Mesh.MeshSizeMax = 6;
Mesh.ElementOrder = order;
Physical Volume("ball") = {1};
Physical Volume("block") = {4};
Physical Surface("surface") = Boundary{Volume{1};};
Physical Surface("socket") = {Surface In BoundingBox{-r - 1, -r - 1, -r - 1, r + 1, r + 1, 1}};
Physical Surface("bottom") = {Surface In BoundingBox{-16, -16, -16, 16, 16, -14}};
