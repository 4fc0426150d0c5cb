// A quarter of a conical plug in its bore, 0.001 apart along the radius; their faces differ round the axis and along it.
Macro SweptBlock
  Point(p + 1) = {inner, 0, 0}; Point(p + 2) = {outer, 0, 0}; Point(p + 3) = {outer + 2, 0, 4}; Point(p + 4) = {inner + 2, 0, 4};
  Line(p + 1) = {p + 1, p + 2}; Line(p + 2) = {p + 2, p + 3}; Line(p + 3) = {p + 3, p + 4}; Line(p + 4) = {p + 4, p + 1};
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4}; Plane Surface(p + 1) = {p + 1};
  Transfinite Curve {p + 1, p + 3} = 3; Transfinite Curve {p + 2, p + 4} = along + 1;
  Transfinite Surface {p + 1}; Recombine Surface {p + 1};
  swept[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 2} { Surface{p + 1}; Layers{round}; Recombine; };
Return
p = 0; inner = 5; outer = 10; along = 2; round = 6; Call SweptBlock;
Physical Volume("plug") = {swept[1]}; Physical Surface("cone") = {swept[3]}; Physical Surface("plug_ends") = {swept[2], swept[4]};
Physical Surface("plug_cut_1") = {p + 1}; Physical Surface("plug_cut_2") = {swept[0]};
p = 100; inner = 10.001; outer = 16; along = 3; round = 10; Call SweptBlock;
Physical Volume("ring") = {swept[1]}; Physical Surface("bore") = {swept[5]}; Physical Surface("ring_ends") = {swept[2], swept[4]};
Physical Surface("ring_cut_1") = {p + 1}; Physical Surface("ring_cut_2") = {swept[0]}; Physical Surface("outside") = {swept[3]};
