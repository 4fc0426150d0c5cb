// A sheet of 1 x 1 x `t` cut into tetrahedra as wide as `h`, on a box: slivers of aspect h / t.
DefineConstant[t = 0.001, h = 0.3, order = 1];
SetFactory("OpenCASCADE"); Mesh.ElementOrder = order; Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h; Mesh.Optimize = 0;
Box(1) = {0, 0, -1, 1, 1, 1}; Box(2) = {0, 0, 0, 1, 1, t};
Physical Volume("box") = {1}; Physical Volume("sheet") = {2};
e = 1e-6;
// OpenCASCADE's order of a box's faces: xmin, xmax, ymin, ymax, zmin, zmax
Physical Surface("box_left") = {1}; Physical Surface("box_front") = {3}; Physical Surface("box_bottom") = {5}; Physical Surface("box_top") = {6};
Physical Surface("sheet_left") = {7}; Physical Surface("sheet_front") = {9}; Physical Surface("sheet_bottom") = {11}; Physical Surface("sheet_top") = {12};
