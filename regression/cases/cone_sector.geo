// A sector of 4 degrees, one cell wide, of a plug in a bore of 45 degrees; the bore begins 0.1 below the plug's end.
angle = 4 * Pi / 180;
Point(1) = {0.4, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {4, 2, 0}; Point(4) = {0.4, 2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(5) = {1.9, -0.1, 0}; Point(6) = {4.5, -0.1, 0}; Point(7) = {4.5, 1.5, 0}; Point(8) = {3.5, 1.5, 0};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = 8; Transfinite Curve {2, 4} = 9; Transfinite Curve {5, 7} = 6; Transfinite Curve {6, 8} = 11;
Transfinite Surface {1, 2}; Recombine Surface {1, 2};
Rotate {{0, 1, 0}, {0, 0, 0}, -angle / 2} { Surface{1, 2}; }
plug[] = Extrude {{0, 1, 0}, {0, 0, 0}, angle} { Surface{1}; Layers{1}; Recombine; };
ring[] = Extrude {{0, 1, 0}, {0, 0, 0}, angle} { Surface{2}; Layers{1}; Recombine; };
Physical Volume("plug") = {plug[1]}; Physical Volume("ring") = {ring[1]};
Physical Surface("cone") = {plug[3]}; Physical Surface("top") = {plug[4]};
Physical Surface("base") = {ring[2]}; Physical Surface("bore") = {ring[5]};
Physical Surface("plug_cut_1") = {1}; Physical Surface("plug_cut_2") = {plug[0]};
Physical Surface("ring_cut_1") = {2}; Physical Surface("ring_cut_2") = {ring[0]};
