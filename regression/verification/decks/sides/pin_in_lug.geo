// A quarter (y > 0, z > 0) of a plate with a hole and of a pin that sticks out of it by `over`: faces of the pin cross the hole's rim.
// shape: 0 tetrahedra, 1 hexahedra, 2 prisms. The pin's cells are a tenth smaller than the plate's.
SetFactory("OpenCASCADE");
DefineConstant[ h = 3, order = 1, shape = 0, incomplete = 0, R = 10, c = 0.05, t = 5, over = 4, W = 30 ];
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromCurvature = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (0.95 + 0.05 * (sqrt(x*x+y*y) - %g) / (abs(sqrt(x*x+y*y) - %g) + 1e-6)) + 0.2 * abs(sqrt(x*x+y*y) - %g)", h, R - c / 2, R - c / 2, R);
Background Field = 1;
Rectangle(1) = {-W, 0, 0, 2 * W, W}; Disk(2) = {0, 0, 0, R};
BooleanDifference{ Surface{1}; Delete; }{ Surface{2}; Delete; }
r = R - c;
Disk(2) = {0, 0, 0, r}; Rectangle(3) = {-2 * r, -2 * r, 0, 4 * r, 2 * r};
BooleanDifference{ Surface{2}; Delete; }{ Surface{3}; Delete; }
If (shape == 1)
  Recombine Surface{1, 2}; Mesh.RecombinationAlgorithm = 2;
EndIf
If (shape == 0)
  Extrude{0, 0, t} { Surface{1}; } Extrude{0, 0, t + over} { Surface{2}; }
Else
  Extrude{0, 0, t} { Surface{1}; Layers{Ceil(t / h)}; Recombine; }
  Extrude{0, 0, t + over} { Surface{2}; Layers{Ceil((t + over) / h / 0.9)}; Recombine; }
EndIf
e = 1e-3;
Physical Volume("plate") = {1}; Physical Volume("pin") = {2};
sy() = Surface In BoundingBox {-W - e, -e, -e, W + e, e, t + over + e};
Physical Surface("cut_y") = {sy()};
sz() = Surface In BoundingBox {-W - e, -e, -e, W + e, W + e, e};
Physical Surface("cut_z") = {sz()};
far() = Surface In BoundingBox {W - e, -e, -e, W + e, W + e, t + e};
Physical Surface("far") = {far()};
end() = Surface In BoundingBox {-W - e, -e, t + over - e, W + e, W + e, t + over + e};
Physical Surface("pin_end") = {end()};
pin() = Surface In BoundingBox {-r - e, -e, -e, r + e, r + e, t + over + e};
both() = Boundary { Volume{2}; }; both() -= sy(); both() -= sz(); both() -= end();
Physical Surface("pin_side") = {both()};
hole() = Surface In BoundingBox {-R - e, -e, -e, R + e, R + e, t + e}; hole() -= sy(); hole() -= sz(); hole() -= both();
Physical Surface("hole") = {hole()};
