// A plug with a flange of radius FLANGE on a plate with a wider hole; the flange stands in the plate by SUNK. mm.
DefineConstant[ SUNK = {0, Name "overlap of flange and plate"}, HOLE = {4.5, Name "radius of the hole"}, FLANGE = {7, Name "its radius"} ];
SetFactory("OpenCASCADE");
Box(1) = {-12, -12, 0, 24, 24, 4};
Cylinder(2) = {0, 0, -1, 0, 0, 6, HOLE};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0, 0, 1, 0, 0, 3 - SUNK, 4};
Cylinder(5) = {0, 0, 4 - SUNK, 0, 0, 4, FLANGE};
BooleanUnion(6) = { Volume{4}; Delete; }{ Volume{5}; Delete; };
Mesh.MeshSizeMax = 6; Mesh.MeshSizeMin = 1; Mesh.MeshSizeFromCurvature = 10;
Physical Volume("plate") = {3}; Physical Volume("plug") = {6};
base[] = Surface In BoundingBox {-13, -13, -0.1, 13, 13, 0.1};
plate[] = Abs(Boundary{ Volume{3}; }); plate[] -= base[];
foot[] = Surface In BoundingBox {-4.1, -4.1, 0.9, 4.1, 4.1, 1.1};
plug[] = Abs(Boundary{ Volume{6}; }); plug[] -= foot[];
Physical Surface("base") = {base[]}; Physical Surface("outside") = {plate[]};
Physical Surface("foot") = {foot[]}; Physical Surface("skin") = {plug[]};
