// Lower half of a cylinder of radius R on a block, plane; cells of size h within `fine` of the contact, growing steadily outside.
// shape: 0 triangles, 1 quadrilaterals. The block's cells are a tenth larger.
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.6, R = 50, W = 100, H = 100, fine = 8, growth = 0.2, order = 1, shape = 1, incomplete = 0 ];
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Disk(1) = {0, R, 0, R};
Rectangle(3) = {-R, R, 0, 2 * R, R};
BooleanDifference{ Surface{1}; Delete; }{ Surface{3}; Delete; }
Rectangle(2) = {-W, -H, 0, 2 * W, H};
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("(1 - 0.05 * y / (abs(y) + 1e-9)) * (%g + %g * 0.5 * (abs(sqrt(x*x+y*y) - %g) + sqrt(x*x+y*y) - %g))", h, growth, fine, fine);
Background Field = 1;
If (shape == 1)
  Recombine Surface {1, 2}; Mesh.RecombinationAlgorithm = 2;
EndIf
e = 1e-3;
Physical Surface("cylinder") = {1}; Physical Surface("block") = {2};
top() = Curve In BoundingBox {-R - e, R - e, -e, R + e, R + e, e};
all() = Boundary { Surface{1}; }; all() -= top();
Physical Curve("cylinder_surface") = {all()}; Physical Curve("cylinder_top") = {top()};
face() = Curve In BoundingBox {-W - e, -e, -e, W + e, e, e}; Physical Curve("block_top") = {face()};
bottom() = Curve In BoundingBox {-W - e, -H - e, -e, W + e, -H + e, e}; Physical Curve("block_bottom") = {bottom()};
