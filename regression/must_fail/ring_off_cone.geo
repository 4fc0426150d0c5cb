// A ring on a cone, meridian section.
Point(1) = {0.5, 0, 0}; Point(2) = {1.2, 0, 0}; Point(3) = {1.5, 1.2, 0}; Point(4) = {0.5, 1.2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Point(11) = {1.2, 0, 0}; Point(12) = {2.2, 0, 0}; Point(13) = {2.2, 1.2, 0}; Point(14) = {1.5, 1.2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11 : 14}; Plane Surface(2) = {2};
Transfinite Curve {1, 3, 11, 13} = 4; Transfinite Curve {2, 4} = 5; Transfinite Curve {12, 14} = 6;
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Physical Surface("shaft") = {1}; Physical Surface("ring") = {2};
Physical Curve("foot") = {1}; Physical Curve("cone") = {2}; Physical Curve("bore") = {14};
Physical Curve("outside") = {12}; Physical Curve("end") = {13};
