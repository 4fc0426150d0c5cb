// Half (y > 0) of a disc that lies on a plate and hangs over its edge x = `edge`, whose line crosses faces of the disc; the plate's other
// edges are far from the disc. shape: 0 tetrahedra, 1 hexahedra, 2 prisms.
SetFactory("OpenCASCADE");
DefineConstant[ h = 2.5, order = 1, shape = 0, incomplete = 0, R = 10, t = 6, edge = 4, W = 20, B = 15, H = 8 ];
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromCurvature = 0;
Disk(1) = {0, 0, 0, R}; Rectangle(2) = {-2 * R, -2 * R, 0, 4 * R, 2 * R};
BooleanDifference{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Rectangle(2) = {-W, 0, 0, W + edge, B};
If (shape == 1)
  Recombine Surface{1, 2}; Mesh.RecombinationAlgorithm = 2;
EndIf
Field[1] = MathEval; Field[1].F = Sprintf("%g + 0.2 * abs(z)", h);
Background Field = 1;
If (shape == 0)
  Extrude{0, 0, t} { Surface{1}; } Extrude{0, 0, -H} { Surface{2}; }
Else
  Extrude{0, 0, t} { Surface{1}; Layers{Ceil(t / h / 0.9)}; Recombine; }
  Extrude{0, 0, -H} { Surface{2}; Layers{Ceil(H / h)}; Recombine; }
EndIf
e = 1e-4;
Physical Volume("disc") = {1}; Physical Volume("plate") = {2};
sy() = Surface In BoundingBox {-W - e, -e, -H - e, W + e, e, t + e}; Physical Surface("cut_y") = {sy()};
top() = Surface In BoundingBox {-R - e, -e, t - e, R + e, R + e, t + e}; Physical Surface("top") = {top()};
base() = Surface In BoundingBox {-W - e, -e, -H - e, W + e, B + e, -H + e}; Physical Surface("base") = {base()};
Physical Surface("disc_bottom") = {1}; Physical Surface("plate_top") = {2};
