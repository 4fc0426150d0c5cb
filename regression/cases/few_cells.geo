// A half disc of radius 5 on a plate that it touches at x = 0; the plate's cells are 8 / n wide, from -4 + shift.
DefineConstant[ n = 5, m = 24, order = 1, shift = 0, incomplete = 1, tri = 0 ];
Point(1) = {-4 + shift, -3, 0}; Point(2) = {4 + shift, -3, 0}; Point(3) = {4 + shift, 0, 0}; Point(4) = {-4 + shift, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = 4; Transfinite Surface {1};
Point(5) = {0, 5, 0}; Point(6) = {-5, 5, 0}; Point(7) = {0, 0, 0}; Point(8) = {5, 5, 0};
Circle(5) = {6, 5, 7}; Circle(6) = {7, 5, 8}; Line(7) = {8, 5}; Line(8) = {5, 6};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve {5, 6} = m + 1; Transfinite Curve {7, 8} = 8;
If (!tri) Recombine Surface {1, 2}; EndIf
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = incomplete;
Physical Surface("plate") = {1}; Physical Surface("disc") = {2};
Physical Curve("base") = {1}; Physical Curve("top") = {3}; Physical Curve("skin") = {5, 6}; Physical Curve("cut") = {7, 8};
