// Two strips, 140 x 1, of 25 and 22 cells; the upper one in halves of 11.
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;
Point(1) = {0, 0, 0}; Point(2) = {140, 0, 0}; Point(3) = {140, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(11) = {0, 1, 0}; Point(12) = {70, 1, 0}; Point(13) = {140, 1, 0};
Point(14) = {140, 2, 0}; Point(15) = {70, 2, 0}; Point(16) = {0, 2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11}; Line(17) = {12, 15};
Curve Loop(2) = {11, 17, 15, 16}; Plane Surface(2) = {2};
Curve Loop(3) = {12, 13, 14, -17}; Plane Surface(3) = {3};
Transfinite Curve {1, 3} = 26; Transfinite Curve {2, 4, 13, 16, 17} = 2; Transfinite Curve {11, 12, 14, 15} = 12;
Transfinite Surface {1, 2, 3};
Physical Surface("lower") = {1}; Physical Surface("upper") = {2, 3};
Physical Curve("lower_left") = {4}; Physical Curve("lower_bottom") = {1}; Physical Curve("lower_top") = {3};
Physical Curve("upper_left") = {16}; Physical Curve("upper_bottom") = {11, 12}; Physical Curve("pressed") = {15};
