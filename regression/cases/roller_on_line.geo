// A cylinder that lies on a block along a line, on which its mesh has no row of nodes.
SetFactory("OpenCASCADE");
DefineConstant[h = {2, Name "Size of the cells"}];
Cylinder(1) = {0, 0, 0, 0, 0, 6, 5};
Box(2) = {-8, -10, -2, 16, 5, 10};
Physical Volume("roller") = {1};
Physical Volume("race") = {2};
Physical Surface("skin") = {1};
Physical Surface("end") = {3};
Physical Surface("top") = {7};
Physical Surface("bottom") = {6};
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
