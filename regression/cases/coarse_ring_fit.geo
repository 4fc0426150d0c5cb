// A quarter of a shaft in its hub, whose radii overlap by 0.001; 15 degrees a face and 9, and faces that differ along the axis.
Macro SweptBlock
  Point(p + 1) = {inner, 0, 0}; Point(p + 2) = {outer, 0, 0}; Point(p + 3) = {outer, 0, 4}; Point(p + 4) = {inner, 0, 4};
  Line(p + 1) = {p + 1, p + 2}; Line(p + 2) = {p + 2, p + 3}; Line(p + 3) = {p + 3, p + 4}; Line(p + 4) = {p + 4, p + 1};
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4}; Plane Surface(p + 1) = {p + 1};
  Transfinite Curve {p + 1, p + 3} = 4; Transfinite Curve {p + 2, p + 4} = along + 1;
  Transfinite Surface {p + 1}; Recombine Surface {p + 1};
  swept[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 2} { Surface{p + 1}; Layers{round}; Recombine; };
Return
p = 0; inner = 5; outer = 10; along = 1; round = 6; Call SweptBlock;
Physical Volume("shaft") = {swept[1]}; Physical Surface("journal") = {swept[3]}; Physical Surface("shaft_ends") = {swept[2], swept[4]};
Physical Surface("shaft_cut_1") = {p + 1}; Physical Surface("shaft_cut_2") = {swept[0]};
p = 100; inner = 9.999; outer = 16; along = 2; round = 10; Call SweptBlock;
Physical Volume("hub") = {swept[1]}; Physical Surface("bore") = {swept[5]}; Physical Surface("hub_ends") = {swept[2], swept[4]};
Physical Surface("hub_cut_1") = {p + 1}; Physical Surface("hub_cut_2") = {swept[0]};
