// A hexagonal key in a hexagonal hole, `c` apart on every side, the mean of the flats' distances 10; the key has a bore through which
// it is pushed. Faces of the two do not match.
SetFactory("OpenCASCADE");
DefineConstant[ h = 1, order = 1, shape = 0, incomplete = 0, c = 0.01 ];
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (0.95 + 0.05 * (sqrt(x*x+y*y) - 5) / (abs(sqrt(x*x+y*y) - 5) + 1e-6)) + 0.2 * abs(sqrt(x*x+y*y) - 5)", h);
Background Field = 1;
For body In {0:1}
  r = (5 + (body - 0.5) * c) / Cos(Pi / 6);
  For i In {0:5}
    Point(10 * body + i + 1) = {r * Cos((i + 0.5) * Pi / 3), r * Sin((i + 0.5) * Pi / 3), 0};
  EndFor
  For i In {0:5}
    Line(10 * body + i + 1) = {10 * body + i + 1, 10 * body + (i + 1) % 6 + 1};
  EndFor
  Curve Loop(body + 1) = {10 * body + 1 : 10 * body + 6};
EndFor
Circle(30) = {0, 0, 0, 2};
Circle(31) = {0, 0, 0, 14};
Curve Loop(3) = {30};
Curve Loop(4) = {31};
Plane Surface(1) = {1, 3};
Plane Surface(2) = {4, 2};
If (shape == 1)
  Recombine Surface{1, 2}; Mesh.RecombinationAlgorithm = 2;
EndIf
Physical Surface("key") = {1};
Physical Surface("ring") = {2};
Physical Curve("flats") = {1:6};
Physical Curve("hole") = {11:16};
Physical Curve("bore") = {30};
Physical Curve("outside") = {31};
