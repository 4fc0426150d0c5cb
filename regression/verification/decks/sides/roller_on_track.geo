// A quarter (x > 0, z > 0) of the lower half of a roller of radius R in a track of radius Rt; half lengths `roller` and `track`: the longer one
// overhangs, its faces cross the other's end. Graded towards the line of contact, y = x = 0.
// shape: 0 tetrahedra, 1 hexahedra, 2 prisms. The roller's cells are a tenth smaller than the track's.
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.3, order = 1, shape = 0, incomplete = 0, R = 8, Rt = 20, roller = 6, track = 5, W = 6, H = 6, g = 0.5, l = 3 ];
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromCurvature = 0;
Point(1) = {0, R, 0}; Point(2) = {0, 0, 0}; Point(3) = {R, R, 0};
Circle(1) = {2, 1, 3}; Line(2) = {3, 1}; Line(3) = {1, 2};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(4) = {0, Rt, 0}; Point(5) = {0, 0, 0}; Point(6) = {W, Rt - Sqrt(Rt^2 - W^2), 0}; Point(7) = {W, -H, 0}; Point(8) = {0, -H, 0};
Circle(4) = {5, 4, 6}; Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 5};
Curve Loop(2) = {4, 5, 6, 7}; Plane Surface(2) = {2};
If (shape == 1)
  Recombine Surface{1, 2}; Mesh.RecombinationAlgorithm = 2;
EndIf
Field[1] = MathEval;
Field[1].F = Sprintf("(0.95 - 0.05 * (y - 0.05 * x * x) / (abs(y - 0.05 * x * x) + 1e-6)) * (%g + %g * 0.5 * (abs(sqrt(x*x+y*y) - 0.8) + sqrt(x*x+y*y) - 0.8))", h, g);
Background Field = 1;
If (shape == 0)
  Extrude{0, 0, roller} { Surface{1}; } Extrude{0, 0, track} { Surface{2}; }
Else
  Extrude{0, 0, roller} { Surface{1}; Layers{Ceil(roller / h / l / 0.9)}; Recombine; }
  Extrude{0, 0, track} { Surface{2}; Layers{Ceil(track / h / l)}; Recombine; }
EndIf
e = 1e-4;
Physical Volume("roller") = {1}; Physical Volume("track") = {2};
sx() = Surface In BoundingBox {-e, -H - e, -e, e, R + e, roller + track}; Physical Surface("cut_x") = {sx()};
Physical Surface("cut_z") = {1, 2};
top() = Surface In BoundingBox {-e, R - e, -e, R + e, R + e, roller + e}; Physical Surface("top") = {top()};
base() = Surface In BoundingBox {-e, -H - e, -e, W + e, -H + e, track + e}; Physical Surface("base") = {base()};
a() = Boundary { Volume{1}; }; b() = Boundary { Volume{2}; };
enda() = Surface In BoundingBox {-e, -H - e, roller - e, R + W, R + e, roller + e};
endb() = Surface In BoundingBox {-e, -H - e, track - e, R + W, R + e, track + e};
a() -= {1}; a() -= sx(); a() -= top(); a() -= enda();
right() = Surface In BoundingBox {W - e, -H - e, -e, W + e, R, track + e};
b() -= {2}; b() -= sx(); b() -= base(); b() -= endb(); b() -= right();
Physical Surface("roller_surface") = {a()}; Physical Surface("track_surface") = {b()};
