// A disc between two plates that it touches in one line each, at `turn` from one of its points: inside an edge of its cells.
//   kind: 0 tetrahedra (2D: triangles), 2 hexahedra (2D: quadrilaterals); order; incomplete; plane: 1 the section alone
SetFactory("OpenCASCADE");
DefineConstant[ kind = 0, order = 1, incomplete = 0, plane = 1, r = 6, h = 1, turn = 0.4 ];
Circle(100) = {0, 0, 0, r, turn, turn + 2 * Pi};
Curve Loop(100) = {100};
Plane Surface(1) = {100};
Rectangle(2) = {-8, r, 0, 16, 4};
Rectangle(3) = {-8, -r - 4, 0, 16, 4};
Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h;
If(kind == 2)
  Mesh.RecombineAll = 1;
  Mesh.RecombinationAlgorithm = 2;
EndIf
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
e = 0.001;
If(plane)
  Physical Surface("disc") = {1};
  Physical Surface("above") = {2};
  Physical Surface("below") = {3};
  Physical Curve("rim") = {100};
  Physical Curve("above_side") = {Curve In BoundingBox{-8 - e, r - e, -e, 8 + e, r + e, e}};
  Physical Curve("below_side") = {Curve In BoundingBox{-8 - e, -r - e, -e, 8 + e, -r + e, e}};
  Physical Curve("top") = {Curve In BoundingBox{-8 - e, r + 4 - e, -e, 8 + e, r + 4 + e, e}};
  Physical Curve("bottom") = {Curve In BoundingBox{-8 - e, -r - 4 - e, -e, 8 + e, -r - 4 + e, e}};
Else
  If(kind == 0)
    a[] = Extrude{0, 0, 2}{Surface{1};};
    b[] = Extrude{0, 0, 2}{Surface{2};};
    c[] = Extrude{0, 0, 2}{Surface{3};};
  Else
    a[] = Extrude{0, 0, 2}{Surface{1}; Layers{2}; Recombine;};
    b[] = Extrude{0, 0, 2}{Surface{2}; Layers{3}; Recombine;};
    c[] = Extrude{0, 0, 2}{Surface{3}; Layers{2}; Recombine;};
  EndIf
  Physical Volume("disc") = {a[1]};
  Physical Volume("above") = {b[1]};
  Physical Volume("below") = {c[1]};
  Physical Surface("rim") = {a[2]};
  Physical Surface("above_side") = {Surface In BoundingBox{-8 - e, r - e, -e, 8 + e, r + e, 2 + e}};
  Physical Surface("below_side") = {Surface In BoundingBox{-8 - e, -r - e, -e, 8 + e, -r + e, 2 + e}};
  Physical Surface("top") = {Surface In BoundingBox{-8 - e, r + 4 - e, -e, 8 + e, r + 4 + e, 2 + e}};
  Physical Surface("bottom") = {Surface In BoundingBox{-8 - e, -r - 4 - e, -e, 8 + e, -r - 4 + e, 2 + e}};
EndIf
