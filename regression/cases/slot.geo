// A key with round ends in a slot, radius 5: NK faces a half circle of the key and FK a flat, NS and FS of the slot; mm.
DefineConstant[ NK = {8, Name "key"}, NS = {12, Name "slot"}, FK = {8, Name "flats of the key"}, FS = {11, Name "of the slot"} ];
n[] = {NK, NS};
flat[] = {FK, FS};
For b In {0:1}
  p = 10 * b;
  Point(p + 1) = {-5, -5, 0}; Point(p + 2) = {5, -5, 0}; Point(p + 3) = {10, 0, 0}; Point(p + 4) = {5, 5, 0}; Point(p + 5) = {-5, 5, 0};
  Point(p + 6) = {-10, 0, 0}; Point(p + 7) = {5, 0, 0}; Point(p + 8) = {-5, 0, 0};
  Line(p + 1) = {p + 1, p + 2}; Circle(p + 2) = {p + 2, p + 7, p + 3}; Circle(p + 3) = {p + 3, p + 7, p + 4};
  Line(p + 4) = {p + 4, p + 5}; Circle(p + 5) = {p + 5, p + 8, p + 6}; Circle(p + 6) = {p + 6, p + 8, p + 1};
  Curve Loop(p + 1) = {p + 1 : p + 6};
  Transfinite Curve {p + 2, p + 3, p + 5, p + 6} = n[b] / 2 + 1;
  Transfinite Curve {p + 1, p + 4} = flat[b] + 1;
EndFor
Plane Surface(1) = {1};
Point(21) = {22, 0, 0}; Point(22) = {0, 22, 0}; Point(23) = {-22, 0, 0}; Point(24) = {0, -22, 0}; Point(25) = {0, 0, 0};
Circle(21) = {21, 25, 22}; Circle(22) = {22, 25, 23}; Circle(23) = {23, 25, 24}; Circle(24) = {24, 25, 21};
Curve Loop(21) = {21 : 24};
Plane Surface(2) = {21, 11};
Mesh.MeshSizeMax = 2;
Mesh.MeshSizeExtendFromBoundary = 1;
Physical Surface("key") = {1}; Physical Surface("plate") = {2};
Physical Curve("round_key") = {1 : 6}; Physical Curve("slot") = {11 : 16}; Physical Curve("rim") = {21 : 24};
