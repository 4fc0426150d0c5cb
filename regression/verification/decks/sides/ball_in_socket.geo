// A ball with a bore in a socket, both bodies of revolution about y: a quarter in space (dim 3), or the section (dim 2, axisymmetric).
// The socket ends at 60 degrees and at a bore of its own, wider than the ball's: both rims cross faces of the ball.
// shape: 0 triangles, tetrahedra; 1 quadrilaterals, hexahedra; 2 prisms. The ball's cells are a tenth smaller than the socket's.
SetFactory("OpenCASCADE");
DefineConstant[ h = 1.5, order = 1, shape = 0, incomplete = 0, dim = 3, R = 10, c = 0.003, W = 16 ];
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromCurvature = 0;
r = R + c;
Point(1) = {0, 0, 0};
Point(2) = {3, -Sqrt(R^2 - 9), 0}; Point(3) = {Sqrt(R^2 - 16), 4, 0}; Point(4) = {3, 4, 0};
Circle(1) = {2, 1, 3}; Line(2) = {3, 4}; Line(3) = {4, 2};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(5) = {4, -Sqrt(r^2 - 16), 0}; Point(6) = {r * Sqrt(3) / 2, -r / 2, 0}; Point(7) = {W, -r / 2, 0}; Point(8) = {W, -W, 0}; Point(9) = {4, -W, 0};
Circle(4) = {5, 1, 6}; Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 9}; Line(8) = {9, 5};
Curve Loop(2) = {4, 5, 6, 7, 8}; Plane Surface(2) = {2};
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (0.95 + 0.05 * (sqrt(x*x+y*y+z*z) - %g) / (abs(sqrt(x*x+y*y+z*z) - %g) + 1e-6)) + 0.2 * abs(sqrt(x*x+y*y+z*z) - %g)", h, R + c / 2, R + c / 2, R);
Background Field = 1;
If (shape == 1)
  Recombine Surface{1, 2}; Mesh.RecombinationAlgorithm = 2;
EndIf
If (dim == 2)
  Physical Surface("ball") = {1}; Physical Surface("socket") = {2};
  Physical Curve("ball_surface") = {1}; Physical Curve("socket_surface") = {4}; Physical Curve("top") = {2}; Physical Curve("base") = {7};
Else
  If (shape == 0)
    Extrude{ {0, 1, 0}, {0, 0, 0}, Pi / 2 } { Surface{1}; } Extrude{ {0, 1, 0}, {0, 0, 0}, Pi / 2 } { Surface{2}; }
  Else
    Extrude{ {0, 1, 0}, {0, 0, 0}, Pi / 2 } { Surface{1}; Layers{Ceil(12 / h / 0.9)}; Recombine; }
    Extrude{ {0, 1, 0}, {0, 0, 0}, Pi / 2 } { Surface{2}; Layers{Ceil(12 / h)}; Recombine; }
  EndIf
  e = 1e-4;
  Physical Volume("ball") = {1}; Physical Volume("socket") = {2};
  Physical Surface("cut_z") = {1, 2};
  sx() = Surface In BoundingBox {-e, -W - e, -W - e, e, W, e}; Physical Surface("cut_x") = {sx()};
  top() = Surface In BoundingBox {-e, 4 - e, -W - e, W + e, 4 + e, W}; Physical Surface("top") = {top()};
  base() = Surface In BoundingBox {-e, -W - e, -W - e, W + e, -W + e, W}; Physical Surface("base") = {base()};
  bore() = Surface In BoundingBox {-e, -W - e, -3 - e, 3 + e, W, e};
  ball() = Boundary { Volume{1}; }; ball() -= {1, 2}; ball() -= sx(); ball() -= top(); ball() -= bore();
  Physical Surface("ball_surface") = {ball()};
  bore() = Surface In BoundingBox {-e, -W - e, -4 - e, 4 + e, W, e};
  rim() = Surface In BoundingBox {-e, -r / 2 - e, -W - e, W + e, -r / 2 + e, W};
  s() = Surface In BoundingBox {-e, -r - e, -r * 0.87 - e, r * 0.87 + e, -r / 2 + e, e}; s() -= sx(); s() -= {1, 2}; s() -= ball(); s() -= bore(); s() -= rim();
  Physical Surface("socket_surface") = {s()};
EndIf
