// Quarter of a hollow shaft (radii a, b) in a hub (b, c), height H; each ring has its own cells, and they do not match on the interface.
SetFactory("OpenCASCADE");     // the other kernel would merge the two sides of the interface
DefineConstant[ n = 4, a = 25, b = 50, c = 100, H = 10, order = 1, layers = 1 ];
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0}; Point(3) = {b, 0, 0}; Point(4) = {0, b, 0}; Point(5) = {0, a, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(12) = {b, 0, 0}; Point(13) = {c, 0, 0}; Point(14) = {0, c, 0}; Point(15) = {0, b, 0};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12};
Curve Loop(11) = {11, 12, 13, 14}; Plane Surface(11) = {11};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = 2 * n + 1;
Transfinite Curve {11, 13} = 3 * n / 2 + 1; Transfinite Curve {12, 14} = 3 * n + 1;
Transfinite Surface {1, 11}; Recombine Surface {1, 11};
shaft() = Extrude {0, 0, H} { Surface{1}; Layers{layers}; Recombine; };
hub() = Extrude {0, 0, H} { Surface{11}; Layers{layers + 1}; Recombine; };
Mesh.ElementOrder = order;
Physical Volume("shaft") = {shaft(1)};
Physical Volume("hub") = {hub(1)};
Physical Surface("shaft_surface") = {shaft(3)};
Physical Surface("hub_bore") = {hub(5)};
Physical Surface("symmetry_y") = {shaft(2), hub(2)};
Physical Surface("symmetry_x") = {shaft(4), hub(4)};
Physical Surface("lower_end") = {1, 11};
Physical Surface("upper_end") = {shaft(0), hub(0)};
