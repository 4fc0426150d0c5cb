// Two blocks of hex20 that meet in the surface x = 0.3 z^2.
Point(1) = {-1.5, 0, 0}; Point(2) = {0, 0, 0}; Point(3) = {1.5, 0, 0};
Point(4) = {-1.5, 0, 1}; Point(5) = {0.3, 0, 1}; Point(6) = {1.5, 0, 1};
Point(7) = {0, 0, 0.5};  // the parabola is a Bezier curve: its tangents meet here
Line(1) = {1, 2}; Bezier(2) = {2, 7, 5}; Line(3) = {5, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(12) = {0, 0, 0}; Point(15) = {0.3, 0, 1}; Point(17) = {0, 0, 0.5};
Line(11) = {12, 3}; Line(12) = {3, 6}; Line(13) = {6, 15}; Bezier(14) = {12, 17, 15};
Curve Loop(2) = {11, 12, 13, -14}; Plane Surface(2) = {2};
Transfinite Curve {1 : 4, 11 : 14} = 4; Transfinite Surface {1}; Transfinite Surface {2}; Recombine Surface {1, 2};
a[] = Extrude {0, 1, 0} { Surface{1}; Layers{3}; Recombine; };
b[] = Extrude {0, 1, 0} { Surface{2}; Layers{3}; Recombine; };
Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1;
Physical Volume("left") = {a[1]}; Physical Volume("right") = {b[1]};
Physical Surface("left_top") = {a[0]}; Physical Surface("right_top") = {b[0]};
Physical Surface("joint") = {a[3]};  // of both
Physical Surface("foot") = {a[5]}; Physical Surface("pressed") = {b[3]};
