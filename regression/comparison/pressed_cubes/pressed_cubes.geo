// Two unit cubes, one on the other, n cells along an edge.
Geometry.AutoCoherence = 0;  // what touches stays two bodies
DefineConstant[ n = 19 ];

Macro Cube
  p = newp; Point(p) = {0, 0, z}; Point(p + 1) = {1, 0, z}; Point(p + 2) = {1, 1, z}; Point(p + 3) = {0, 1, z};
  c = newc; Line(c) = {p, p + 1}; Line(c + 1) = {p + 1, p + 2}; Line(c + 2) = {p + 2, p + 3}; Line(c + 3) = {p + 3, p};
  loop = newll; Curve Loop(loop) = {c, c + 1, c + 2, c + 3};
  s = news; Plane Surface(s) = {loop};
  Transfinite Curve {c : c + 3} = n + 1;
  Transfinite Surface {s}; Recombine Surface {s};
  made[] = Extrude {0, 0, 1} { Surface{s}; Layers{n}; Recombine; };
Return

z = 0;
Call Cube;
Physical Volume("lower") = {made[1]};
Physical Surface("lower_bottom") = {s};
Physical Surface("lower_top") = {made[0]};
z = 1;
Call Cube;
Physical Volume("upper") = {made[1]};
Physical Surface("upper_bottom") = {s};
Physical Surface("upper_top") = {made[0]};
