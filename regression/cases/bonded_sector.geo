// A sector of 60 degrees of a hub and a ring round it. Nodes of both match on the joint, and on the ring's cuts, but not on the hub's.
c = Cos(Pi / 3); s = Sin(Pi / 3);
Point(1) = {0, 0, 0};
Point(2) = {4, 0, 0}; Point(3) = {10, 0, 0}; Point(4) = {10 * c, 10 * s, 0}; Point(5) = {4 * c, 4 * s, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(13) = {10, 0, 0}; Point(14) = {10 * c, 10 * s, 0}; Point(12) = {15, 0, 0}; Point(15) = {15 * c, 15 * s, 0};
Line(11) = {13, 12}; Circle(12) = {12, 1, 15}; Line(13) = {15, 14}; Circle(14) = {14, 1, 13};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {1} = 7; Transfinite Curve {3} = 10; Transfinite Curve {2, 14, 12, 4} = 13; Transfinite Curve {11, 13} = 7;
Recombine Surface {:};
Physical Surface("hub") = {1}; Physical Surface("ring") = {2};
Physical Curve("hub_low") = {1}; Physical Curve("hub_high") = {3}; Physical Curve("ring_low") = {11}; Physical Curve("ring_high") = {13};
Physical Curve("outside_of_hub") = {2}; Physical Curve("inside_of_ring") = {14}; Physical Curve("bore") = {4};
