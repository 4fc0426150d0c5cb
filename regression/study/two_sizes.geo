// Two sizes of cells: which one a study divides is the user's choice.
DefineConstant[ coarse = 0.5, fine = 0.2 ];
Point(1) = {0, 0, 0, fine}; Point(2) = {1, 0, 0, coarse}; Point(3) = {0, 1, 0, coarse};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Physical Surface("plate") = {1};
Physical Curve("side") = {3};
