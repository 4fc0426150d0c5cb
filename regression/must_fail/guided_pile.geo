// A round pile.
SetFactory("OpenCASCADE");
DefineConstant[ order = 1, size = 0.5 ];
Cylinder(1) = {3, -2, 0, 0, 0, 5, 1};
Mesh.ElementOrder = order;
Mesh.MeshSizeMax = size; Mesh.MeshSizeMin = size;
Physical Volume("pile") = {1};
Physical Surface("skin") = {1};
Physical Surface("top") = {2};
