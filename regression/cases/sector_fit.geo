// A sector of 40 degrees of a solid shaft, radius 1, in a hub, radius 2; the shaft's tip is the axis.
SetFactory("OpenCASCADE");   // which leaves each body a rim of its own
DefineConstant[ n = 6, order = 2 ];
from = 25 * Pi / 180; to = 65 * Pi / 180;
Point(1) = {0, 0, 0};
Point(2) = {Cos(from), Sin(from), 0}; Point(3) = {Cos(to), Sin(to), 0};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(12) = {Cos(from), Sin(from), 0}; Point(13) = {2 * Cos(from), 2 * Sin(from), 0};
Point(14) = {2 * Cos(to), 2 * Sin(to), 0}; Point(15) = {Cos(to), Sin(to), 0};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12};
Curve Loop(11) = {11, 12, 13, 14}; Plane Surface(11) = {11};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2} = n + 1;
Transfinite Curve {11, 13} = n + 1; Transfinite Curve {12, 14} = n + 2;
Transfinite Surface {11}; Recombine Surface {11};
shaft() = Extrude {0, 0, 0.5} { Surface{1}; Layers{1}; Recombine; };
hub() = Extrude {0, 0, 0.5} { Surface{11}; Layers{1}; Recombine; };
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = 1;
Physical Volume("shaft") = {shaft(1)};
Physical Volume("hub") = {hub(1)};
Physical Surface("ends") = {1, 11, shaft(0), hub(0)};
Physical Surface("cut_1") = {shaft(2), hub(2)};
Physical Surface("rim") = {shaft(3)};
Physical Surface("cut_2") = {shaft(4), hub(4)};
Physical Surface("bore") = {hub(5)};
