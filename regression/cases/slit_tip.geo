// A square with a slit from the middle of its top to its own middle: the tip is a point of both sides.
DefineConstant[ order = 1, left = 5, right = 5 ];
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {1, 0, 0}; Point(4) = {1, 1, 0}; Point(5) = {0.5, 1, 0};
Point(6) = {0.5, 1, 0}; Point(7) = {0, 1, 0}; Point(8) = {0.5, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 8}; Line(3) = {8, 6}; Line(4) = {6, 7}; Line(5) = {7, 1};
Line(6) = {2, 3}; Line(7) = {3, 4}; Line(8) = {4, 5}; Line(9) = {5, 8};
Curve Loop(1) = {1 : 5}; Curve Loop(2) = {6 : 9, -2};
Plane Surface(1) = {1}; Plane Surface(2) = {2};
Transfinite Curve {3} = left + 1; Transfinite Curve {9} = right + 1;
Mesh.MeshSizeMax = 0.25; Mesh.ElementOrder = order;
Physical Surface("plate") = {1, 2};
Physical Curve("slit_left") = {3}; Physical Curve("slit_right") = {9};
Physical Curve("held") = {5}; Physical Curve("below") = {1, 6}; Physical Curve("pressed") = {7};
