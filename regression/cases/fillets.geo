// A block whose lower edges have fillets of radius R, on a plate; its upright edges are sharp, so that fillets meet in mitres. mm.
DefineConstant[ R = {1.5, Name "fillet"}, SIZE = {0.9, Name "cells"}, ROUND = {20, Name "faces a circle"} ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 6, 5, 4};
lower[] = Curve In BoundingBox {-0.1, -0.1, -0.1, 6.1, 5.1, 0.1};
block[] = Fillet{1}{lower[]}{R};
Box(10) = {-3, -3, -4, 12, 11, 4};
Mesh.MeshSizeMax = SIZE; Mesh.MeshSizeFromCurvature = ROUND;
all[] = Abs(Boundary{ Volume{block[0]}; });
top[] = Surface In BoundingBox {-0.1, -0.1, 3.9, 6.1, 5.1, 4.1};
all[] -= top[];
Physical Volume("block") = {block[0]}; Physical Volume("plate") = {10};
Physical Surface("top") = {top[]}; Physical Surface("foot") = {all[]};
face[] = Surface In BoundingBox {-3.1, -3.1, -0.1, 9.1, 8.1, 0.1};
face[] -= all[];
Physical Surface("face") = {face[]};
Physical Surface("base") = {Surface In BoundingBox {-3.1, -3.1, -4.1, 9.1, 8.1, -3.9}};
