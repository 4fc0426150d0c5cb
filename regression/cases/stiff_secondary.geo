// Half a wave of a soft block, 24 faces, under a flat block of 30. Transfinite, eight nodes a cell.
DefineConstant[lambda = 10, swing = 0.005];
n = 24;
For i In {0:2 * n}
  Point(1 + i) = {i * lambda / (4 * n), swing * (Cos(Pi * i / (2 * n)) - 1), 0};
EndFor
Spline(1) = {1:2 * n + 1};
Point(101) = {0, -12, 0}; Point(102) = {lambda / 2, -12, 0};
Line(2) = {2 * n + 1, 102}; Line(3) = {102, 101}; Line(4) = {101, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(201) = {0, 0, 0}; Point(202) = {lambda / 2, 0, 0}; Point(203) = {lambda / 2, 12, 0}; Point(204) = {0, 12, 0};
Line(11) = {201, 202}; Line(12) = {202, 203}; Line(13) = {203, 204}; Line(14) = {204, 201};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {11, 13} = 31;
Transfinite Curve {2} = 17 Using Progression 1.15; Transfinite Curve {-4} = 17 Using Progression 1.15;
Transfinite Curve {12} = 13 Using Progression 1.15; Transfinite Curve {-14} = 13 Using Progression 1.15;
Transfinite Surface {1}; Transfinite Surface {2}; Recombine Surface {1, 2};
Physical Surface("soft") = {1}; Physical Surface("stiff") = {2};
Physical Curve("wave") = {1}; Physical Curve("flat") = {11};
Physical Curve("bottom") = {3}; Physical Curve("top") = {13};
Physical Curve("sides") = {2, 4, 12, 14};
Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1;
