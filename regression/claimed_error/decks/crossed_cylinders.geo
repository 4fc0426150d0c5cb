// Quarters of two crossed cylinders of radius R that touch at the origin, graded towards it: cells of twenty nodes. Each is W wide and deep.
DefineConstant[ R = 10, W = 3, n = 8, g = 1.35 ]; // n cells along each side, each g times as long as the one before
Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1; Geometry.OldNewReg = 0;
For i In {1:n}
  layers[] += {1}; height[] += {(g^i - 1) / (g^n - 1)};
EndFor
d = R - Sqrt(R * R - W * W);
For b In {0:1}
  up = 1 - 2 * b; p = newp; l = newl;  // the upper one about y, the lower one about x
  cells = n - b; other = 1 - b;
  Point(p) = {0, 0, 0}; Point(p + 1) = {W * other, W * b, d * up}; Point(p + 2) = {W * other, W * b, W * up}; Point(p + 3) = {0, 0, W * up}; Point(p + 4) = {0, 0, R * up};
  Circle(l) = {p, p + 4, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 3, p + 2}; Line(l + 3) = {p, p + 3};
  Curve Loop(b + 1) = {l, l + 1, -(l + 2), -(l + 3)}; s = news; Plane Surface(s) = {b + 1};
  Transfinite Curve {l, l + 2, l + 1, l + 3} = cells + 1 Using Progression g; Transfinite Surface {s}; Recombine Surface {s};
  body~{b}[] = Extrude {W * b, W * other, 0} { Surface{s}; Layers{layers[], height[]}; Recombine; };
  start~{b} = s;
EndFor
Physical Volume("upper") = {body_0[1]}; Physical Volume("lower") = {body_1[1]};
Physical Surface("upper_round") = {body_0[2]}; Physical Surface("lower_round") = {body_1[2]};
Physical Surface("top") = {body_0[4]}; Physical Surface("bottom") = {body_1[4]};
Physical Surface("cut_x") = {body_0[5], start_1}; Physical Surface("cut_y") = {start_0, body_1[5]};
