// A slice of the bearing through its most loaded roller: half of it, a piece of each ring, plane; graded towards both contacts, where the sides do not match.
DefineConstant[ h = 0.02 ];                        // cell size at the contacts
DefineConstant[ bore = 150, F = 170, O = 196, OD = 210, R = 13, W = 15 ]; // radii: bore, raceways, outside, roller; width of a half ring piece
DefineConstant[ d = 0.8 ];                         // extent of the fine part, 2.5 half widths of the contact
DefineConstant[ order = 1 ];                       // 2: cells of second order
Mesh.ElementOrder = order; Mesh.Algorithm = 6; Geometry.OldNewReg = 0;
coarse = 1.5;

Point(1) = {0, 0, 0};                              // axis of the bearing; the roller is below it
Point(2) = {0, -F - R, 0, coarse};                 // axis of the roller
Point(3) = {0, -F, 0, h}; Point(4) = {R * Sin(d / R), -F - R + R * Cos(d / R), 0, h};
Point(5) = {R, -F - R, 0, coarse};
Point(6) = {R * Sin(d / R), -F - R - R * Cos(d / R), 0, h}; Point(7) = {0, -O, 0, h};
Circle(1) = {3, 2, 4}; Circle(2) = {4, 2, 5}; Circle(3) = {5, 2, 6}; Circle(4) = {6, 2, 7}; Line(5) = {7, 2}; Line(6) = {2, 3};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};

e = 0.8 * d;                                       // other cells than opposite
Point(11) = {e, -Sqrt(F * F - e * e), 0, h}; Point(12) = {W, -Sqrt(F * F - W * W), 0, coarse};
Point(13) = {W, -Sqrt(bore * bore - W * W), 0, 3}; Point(14) = {0, -bore, 0, 3};
Point(15) = {0, -F, 0, h};
Circle(11) = {15, 1, 11}; Circle(12) = {11, 1, 12}; Line(13) = {12, 13}; Circle(14) = {13, 1, 14}; Line(15) = {14, 15};
Curve Loop(2) = {11, 12, 13, 14, 15}; Plane Surface(2) = {2};

Point(21) = {0, -O, 0, h}; Point(22) = {e, -Sqrt(O * O - e * e), 0, h}; Point(23) = {W, -Sqrt(O * O - W * W), 0, coarse};
Point(24) = {W, -Sqrt(OD * OD - W * W), 0, 3}; Point(25) = {0, -OD, 0, 3};
Circle(21) = {21, 1, 22}; Circle(22) = {22, 1, 23}; Line(23) = {23, 24}; Circle(24) = {24, 1, 25}; Line(25) = {25, 21};
Curve Loop(3) = {21, 22, 23, 24, 25}; Plane Surface(3) = {3};

Transfinite Curve {1, 4} = Ceil(d / h) + 1;
Transfinite Curve {11, 21} = Ceil(0.7 * e / h) + 1;
Recombine Surface {1, 2, 3};

Physical Surface("roller") = {1};
Physical Surface("inner_ring") = {2};
Physical Surface("outer_ring") = {3};
Physical Curve("roller_surface") = {1, 4};
Physical Curve("inner_raceway") = {11};
Physical Curve("outer_raceway") = {21};
Physical Curve("bore") = {14};
Physical Curve("housing") = {24};
Physical Curve("symmetry") = {5, 6, 15, 25};
Physical Curve("cut") = {13, 23};
