// Quarter of a hollow shaft (radii a, b) in a hub (radii b, c); each ring has its own cells, and they do not match on the interface.
DefineConstant[ n = 8 ];      // cells across the shaft
DefineConstant[ a = 25, b = 50, c = 100 ];
DefineConstant[ hub = 3 ];    // cells round the hub, in n; 2 for meshes that match on the interface
DefineConstant[ across = n + 2 ];   // cells across the hub
ns = 2 * n; nh = hub * n;     // round the shaft, round the hub

Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0}; Point(3) = {b, 0, 0}; Point(4) = {0, b, 0}; Point(5) = {0, a, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};

Point(12) = {b, 0, 0}; Point(13) = {c, 0, 0}; Point(14) = {0, c, 0}; Point(15) = {0, b, 0};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Circle(14) = {15, 1, 12};
Curve Loop(11) = {11, 12, 13, 14}; Plane Surface(11) = {11};

Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = ns + 1;
Transfinite Curve {11, 13} = across + 1; Transfinite Curve {12, 14} = nh + 1;
Transfinite Surface {1, 11}; Recombine Surface {1, 11};
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;

Physical Surface("shaft") = {1};
Physical Surface("hub") = {11};
Physical Curve("shaft_surface") = {2};
Physical Curve("hub_bore") = {14};
Physical Curve("symmetry_x") = {3, 13};   // on x = 0
Physical Curve("symmetry_y") = {1, 11};   // on y = 0
