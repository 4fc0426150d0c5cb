// A third of a disc, radius 1, height 0.4: its two cuts meet on the axis, and their meshes do not match.
SetFactory("OpenCASCADE");
DefineConstant[ order = 2, size = 0.2 ];
Cylinder(1) = {0, 0, 0, 0, 0, 0.4, 1, 120 * Pi / 180};
Mesh.MeshSizeMax = size; Mesh.ElementOrder = order;
Physical Volume("disc") = {1};
Physical Surface("rim") = {1}; Physical Surface("top") = {2}; Physical Surface("foot") = {3};
Physical Surface("from") = {4}; Physical Surface("to") = {5};
