// A block on a larger one; n cells an edge length of the upper, and the two meshes do not match.
Geometry.AutoCoherence = 0;    // what touches stays two bodies
DefineConstant[ n = 6 ];
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1;

Macro Brick   // x0, y0, z0: lowest corner; dx, dy, dz: size; nx, ny, nz: cells
  p = newp; Point(p) = {x0, y0, z0}; Point(p + 1) = {x0 + dx, y0, z0}; Point(p + 2) = {x0 + dx, y0 + dy, z0}; Point(p + 3) = {x0, y0 + dy, z0};
  c = newc; Line(c) = {p, p + 1}; Line(c + 1) = {p + 1, p + 2}; Line(c + 2) = {p + 2, p + 3}; Line(c + 3) = {p + 3, p};
  loop = newll; Curve Loop(loop) = {c, c + 1, c + 2, c + 3};
  s = news; Plane Surface(s) = {loop};
  Transfinite Curve {c, c + 2} = nx + 1; Transfinite Curve {c + 1, c + 3} = ny + 1;
  Transfinite Surface {s}; Recombine Surface {s};
  made[] = Extrude {0, 0, dz} { Surface{s}; Layers{nz}; Recombine; };
Return

x0 = 0; y0 = 0; z0 = 0; dx = 2; dy = 2; dz = 1; nx = 1.5 * n; ny = 1.5 * n; nz = n;
Call Brick;
Physical Volume("lower") = {made[1]};
Physical Surface("lower_bottom") = {s};
Physical Surface("lower_top") = {made[0]};
x0 = 0.5; y0 = 0.5; z0 = 1; dx = 1; dy = 1; dz = 1; nx = n; ny = n; nz = n;
Call Brick;
Physical Volume("upper") = {made[1]};
Physical Surface("upper_bottom") = {s};
Physical Surface("upper_top") = {made[0]};
