// Rollers of radius 0.5 between an outer ring (inner radius 3) and a shaft (radius 2).
DefineConstant[n = 8, h = 0.2];
SetFactory("OpenCASCADE");
Mesh.ElementOrder = 1; Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h; Mesh.MeshSizeFromCurvature = 0;
Disk(1) = {0, 0, 0, 2};
Disk(2) = {0, 0, 0, 3.5}; Disk(3) = {0, 0, 0, 3};
BooleanDifference(4) = { Surface{2}; Delete; }{ Surface{3}; Delete; };
For k In {0 : n - 1}
  Disk(100 + k) = {2.5 * Cos(2 * Pi * (k + 0.25) / n), 2.5 * Sin(2 * Pi * (k + 0.25) / n), 0, 0.5};
  rim(k) = 100 + k;
EndFor
Physical Surface("shaft") = {1}; Physical Surface("ring") = {4}; Physical Surface("rollers") = {rim()};
shaft() = Boundary{ Surface{1}; }; ring() = Boundary{ Surface{4}; }; all() = Boundary{ Surface{rim()}; };
Physical Curve("shaft_rim") = {Abs(shaft(0))};
outer = -1; inner = -1;
For k In {0 : 1}
  box() = BoundingBox Curve{Abs(ring(k))};
  If (box(3) > 3.25) outer = Abs(ring(k)); Else inner = Abs(ring(k)); EndIf
EndFor
Physical Curve("seat") = {outer}; Physical Curve("race") = {inner};
Physical Curve("roller_rims") = {all()};
