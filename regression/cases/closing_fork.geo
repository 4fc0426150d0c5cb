// A fork: two legs of 16 x 4, a gap of 0.5 between them, a web. deep = 0: plane; else as deep as that.
DefineConstant[ deep = 0 ];
Point(1) = {0, 0, 0}; Point(2) = {20, 0, 0}; Point(3) = {20, 4, 0}; Point(4) = {4, 4, 0};
Point(5) = {4, 4.5, 0}; Point(6) = {20, 4.5, 0}; Point(7) = {20, 8.5, 0}; Point(8) = {0, 8.5, 0};
For k In {1:8}
  Line(k) = {k, 1 + k % 8};
EndFor
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
Mesh.MeshSizeMax = 1.2; Mesh.ElementOrder = 2;
If (deep == 0)
  Physical Surface("fork") = {1};
  Physical Curve("bottom") = {1}; Physical Curve("lower_tip") = {2}; Physical Curve("lower") = {3};
  Physical Curve("upper") = {5}; Physical Curve("upper_tip") = {6}; Physical Curve("top") = {7}; Physical Curve("back") = {8};
Else
  out[] = Extrude {0, 0, deep} { Surface{1}; };
  Physical Volume("fork") = {out[1]};
  Physical Surface("bottom") = {out[2]}; Physical Surface("lower_tip") = {out[3]}; Physical Surface("lower") = {out[4]};
  Physical Surface("upper") = {out[6]}; Physical Surface("upper_tip") = {out[7]}; Physical Surface("top") = {out[8]};
  Physical Surface("back") = {out[9]};
EndIf
