// A quarter of a hollow shaft whose end has a fillet of radius 3, in a longer hub. mm.
DefineConstant[ SIZE = {2, Name "cells"}, ROWS = {0, Name "rows round the quarter; 0: unstructured"} ];
SetFactory("OpenCASCADE");
R = 3;
Point(1) = {4, 0, 0}; Point(2) = {10, 0, 0}; Point(3) = {10, 0, 16 - R}; Point(4) = {10 - R, 0, 16 - R}; Point(5) = {10 - R, 0, 16}; Point(6) = {4, 0, 16};
Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 4, 5}; Line(4) = {5, 6}; Line(5) = {6, 1};
Curve Loop(1) = {1 ... 5}; Plane Surface(1) = {1};
Point(11) = {10, 0, 0}; Point(12) = {18, 0, 0}; Point(13) = {18, 0, 24}; Point(14) = {10, 0, 24};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11 ... 14}; Plane Surface(2) = {2};
If (ROWS > 0)
  shaft[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Surface{1}; Layers{ROWS}; Recombine; };
  hub[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Surface{2}; Layers{ROWS + 1}; Recombine; };
  Mesh.RecombineAll = 1;
Else
  shaft[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Surface{1}; };
  hub[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi / 2 } { Surface{2}; };
EndIf
Mesh.MeshSizeMax = SIZE;
// Sides of the shaft as they follow from its lines 1 to 5: foot, cylinder, fillet, end, hole.
Physical Volume("shaft") = {shaft[1]}; Physical Volume("hub") = {hub[1]};
Physical Surface("pin") = {shaft[3], shaft[4]};
Physical Surface("bore") = {hub[5]};
Physical Surface("foot") = {shaft[2]}; Physical Surface("base") = {hub[2]};
Physical Surface("y0") = {1, 2}; Physical Surface("x0") = {shaft[0], hub[0]};
