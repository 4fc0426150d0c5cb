// A shaft of radius 1 and length 4 along z, off the origin.
SetFactory("OpenCASCADE");
DefineConstant[h = 0.7];
Cylinder(1) = {3, -2, 1, 0, 0, 4, 1};
Physical Volume("shaft") = {1};
Physical Surface("side") = {1};
Physical Surface("far") = {2};
Physical Surface("near") = {3};
Mesh.MeshSizeMax = h;
Mesh.MeshSizeMin = h;
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 0;
