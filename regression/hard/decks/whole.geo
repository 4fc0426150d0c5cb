// A stamp over a thin plate, each with its whole surface as one boundary; `overlap` of the stamp with the plate.
DefineConstant[overlap = 0, t = 0.05];
SetFactory("OpenCASCADE"); Mesh.ElementOrder = 1; Mesh.MeshSizeMin = 0.25; Mesh.MeshSizeMax = 0.25;
Box(1) = {0, 0, -t, 1, 1, t}; Box(2) = {0, 0, -overlap, 1, 1, 1};
Physical Volume("plate") = {1}; Physical Volume("stamp") = {2};
Physical Surface("plate_surface") = {1 : 6}; Physical Surface("stamp_surface") = {7 : 12};
Physical Surface("plate_bottom") = {5}; Physical Surface("stamp_top") = {12}; Physical Surface("stamp_bottom") = {11}; Physical Surface("plate_top") = {6};
