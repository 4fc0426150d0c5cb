// A sector of 72 degrees of a hub and a ring round it, whose cuts match, but not their nodes on the joint.
DefineConstant[in_hub = 7, in_ring = 9];
c = Cos(2 * Pi / 5); s = Sin(2 * Pi / 5);
Point(1) = {0, 0, 0};
Point(2) = {20, 0, 0}; Point(3) = {30, 0, 0}; Point(4) = {30 * c, 30 * s, 0}; Point(5) = {20 * c, 20 * s, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(13) = {30, 0, 0}; Point(14) = {30 * c, 30 * s, 0}; Point(12) = {45, 0, 0}; Point(15) = {45 * c, 45 * s, 0};
Line(11) = {13, 12}; Circle(12) = {12, 1, 15}; Line(13) = {15, 14}; Circle(14) = {14, 1, 13};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {1, 3, 11, 13} = 5; Transfinite Curve {2, 4} = in_hub + 1; Transfinite Curve {12, 14} = in_ring + 1;
Transfinite Surface {1, 2}; Recombine Surface {:};
Physical Surface("hub") = {1}; Physical Surface("ring") = {2};
Physical Curve("hub_low") = {1}; Physical Curve("hub_high") = {3}; Physical Curve("ring_low") = {11}; Physical Curve("ring_high") = {13};
Physical Curve("outside_of_hub") = {2}; Physical Curve("inside_of_ring") = {14};
Physical Curve("bore") = {4}; Physical Curve("rim") = {12};
