// Half of a pin in the bore of a plate, with the clearance 2 c between their diameters; slice: one cell thick, of six faces, or plane.
DefineConstant[ R = 10, c = 0.02, W = 30, h = 1.2, slice = 0, order = 1 ]; // h: cell size in the contact
Mesh.ElementOrder = order; Mesh.Algorithm = 6; Geometry.OldNewReg = 0;
Point(1) = {0, -c, 0, 3 * h}; Point(2) = {0, -R, 0, h}; Point(3) = {R - c, -c, 0, h}; Point(4) = {0, R - 2 * c, 0, 3 * h};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 1}; Line(4) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0}; Point(12) = {0, -R, 0, 0.8 * h}; Point(13) = {R, 0, 0, 0.8 * h}; Point(14) = {0, R, 0, 3 * h};
Point(15) = {0, -W, 0, 5 * h}; Point(16) = {W, -W, 0, 5 * h}; Point(17) = {W, W, 0, 5 * h}; Point(18) = {0, W, 0, 5 * h};
Circle(11) = {12, 11, 13}; Circle(12) = {13, 11, 14}; Line(13) = {14, 18}; Line(14) = {18, 17}; Line(15) = {17, 16}; Line(16) = {16, 15}; Line(17) = {15, 12};
Curve Loop(2) = {11, 12, 13, 14, 15, 16, 17}; Plane Surface(2) = {2};
Recombine Surface {1, 2};
If(slice)
  pin[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; };
  plate[] = Extrude {0, 0, 1} { Surface{2}; Layers{1}; Recombine; };
  Physical Volume("pin") = {pin[1]}; Physical Volume("plate") = {plate[1]};
  Physical Surface("sides") = {1, 2, pin[0], plate[0]};
  Physical Surface("rim") = {pin[2], pin[3]}; Physical Surface("middle") = {pin[4], pin[5], plate[4], plate[8]};
  Physical Surface("bore") = {plate[2], plate[3]}; Physical Surface("base") = {plate[7]};
Else
  Physical Surface("pin") = {1}; Physical Surface("plate") = {2};
  Physical Curve("rim") = {1, 2}; Physical Curve("middle") = {3, 4, 13, 17}; Physical Curve("bore") = {11, 12}; Physical Curve("base") = {16};
EndIf
