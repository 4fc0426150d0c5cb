// A pointed body, apex down, over a block: one node touches.
DefineConstant[h = 0.2];
Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h;
Point(1) = {0, 0, 0}; Point(2) = {1, 0.5, 0}; Point(3) = {1, 1.5, 0}; Point(4) = {-1, 1.5, 0}; Point(5) = {-1, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1 : 5}; Plane Surface(1) = {1};
Point(11) = {-2, -1, 0}; Point(12) = {2, -1, 0}; Point(13) = {2, 0, 0}; Point(14) = {-2, 0, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11 : 14}; Plane Surface(2) = {2};
Physical Surface("pointed") = {1}; Physical Surface("block") = {2};
Physical Curve("flanks") = {1, 5}; Physical Curve("sides") = {2, 4}; Physical Curve("top") = {3}; Physical Curve("bottom") = {11}; Physical Curve("face") = {13};
