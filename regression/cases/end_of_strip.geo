// Two strips 500 x 1 on each other, with cells that do not match; `pressed` is the upper one's top up to 25 / 85 of its length.
length = 500;
Point(1) = {0, 0, 0}; Point(2) = {length, 0, 0}; Point(3) = {length, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 72; Transfinite Curve {2, 4} = 3;
Transfinite Surface {1}; Recombine Surface {1};

part = length * 25 / 85;
Point(11) = {0, 1, 0}; Point(12) = {part, 1, 0}; Point(13) = {length, 1, 0};
Point(14) = {length, 2, 0}; Point(15) = {part, 2, 0}; Point(16) = {0, 2, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11};
Line(17) = {12, 15};
Curve Loop(2) = {11, 17, 15, 16}; Plane Surface(2) = {2};
Curve Loop(3) = {12, 13, 14, -17}; Plane Surface(3) = {3};
Transfinite Curve {11, 15} = 26; Transfinite Curve {12, 14} = 61; Transfinite Curve {13, 16, 17} = 2;
Transfinite Surface {2, 3}; Recombine Surface {2, 3};

Physical Surface("lower") = {1};
Physical Surface("upper") = {2, 3};
Physical Curve("lower.bottom") = {1};
Physical Curve("lower.top") = {3};
Physical Curve("lower.left") = {4};
Physical Curve("upper.bottom") = {11, 12};
Physical Curve("upper.left") = {16};
Physical Curve("pressed") = {15};
