// A 2 x 2 board of squares that share nodes, two bodies of two squares each that meet in the middle: each body's parts share a vertex alone.
DefineConstant[n = 4];
Mesh.RecombineAll = 1;
For j In {0 : 2}
  For i In {0 : 2}
    Point(1 + i + 3 * j) = {i, j, 0};
  EndFor
EndFor
For j In {0 : 2}
  For i In {0 : 1}
    Line(1 + i + 2 * j) = {1 + i + 3 * j, 2 + i + 3 * j};
  EndFor
EndFor
For j In {0 : 1}
  For i In {0 : 2}
    Line(11 + i + 3 * j) = {1 + i + 3 * j, 4 + i + 3 * j};
  EndFor
EndFor
For j In {0 : 1}
  For i In {0 : 1}
    Curve Loop(1 + i + 2 * j) = {1 + i + 2 * j, 12 + i + 3 * j, -(3 + i + 2 * j), -(11 + i + 3 * j)};
    Plane Surface(1 + i + 2 * j) = {1 + i + 2 * j};
  EndFor
EndFor
Transfinite Curve{1 : 6, 11 : 16} = n + 1; Transfinite Surface{1 : 4};
Physical Surface("black") = {1, 4}; Physical Surface("white") = {2, 3};
Physical Curve("bottom") = {1, 2}; Physical Curve("top") = {5, 6}; Physical Curve("seams") = {12, 15, 3, 4}; Physical Curve("sides") = {11, 14, 13, 16};
