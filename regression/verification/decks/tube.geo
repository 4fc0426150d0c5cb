// Quarter of a thick tube, radii 1 and 2, cells as asked for; extruded by H in `layers` layers in 3D.
DefineConstant[ n = 4, quads = 1, order = 1, incomplete = 0, three = 0, H = 0.5 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 2, 0}; Point(5) = {0, 1, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = 2 * n + 1;
Transfinite Surface {1} = {2, 3, 4, 5} Alternate;
If (quads == 1)
  Recombine Surface {1};
EndIf
If (three == 0)
  Physical Surface("tube") = {1};
  Physical Curve("bore") = {4};
  Physical Curve("symmetry_x") = {3};
  Physical Curve("symmetry_y") = {1};
EndIf
If (three == 1)   // prisms or hexahedra
  out() = Extrude {0, 0, H} { Surface{1}; Layers{Ceil(n / 2)}; Recombine; };
EndIf
If (three == 2)   // tetrahedra
  out() = Extrude {0, 0, H} { Surface{1}; Layers{Ceil(n / 2)}; };
EndIf
If (three > 0)
  Physical Volume("tube") = {out(1)};
  Physical Surface("symmetry_y") = {out(2)};
  Physical Surface("symmetry_x") = {out(4)};
  Physical Surface("bore") = {out(5)};
  Physical Surface("ends") = {1, out(0)};
EndIf
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
