// Two blocks, one on the other, that meet in a wavy surface which stands askew on all their sides. Their meshes do not match.
DefineConstant[lower = 4, upper = 3];
For b In {0 : 1}
  o = 100 * b; cells = b == 0 ? lower : upper; far = 2 * b;
  For i In {0 : 3}
    x = (i == 1 || i == 2) ? 1 : 0; z = i > 1 ? 1 : 0;
    xm = i == 0 || i == 2 ? 0.5 : (i == 1 ? 1 : 0); zm = i == 1 || i == 3 ? 0.5 : (i == 2 ? 1 : 0);  // the middle of the edge to the next
    Point(o + i + 1) = {x, far, z};
    Point(o + i + 5) = {x, 1 + 0.12 * Sin(1.5 * x - z), z};
    Point(o + i + 9) = {xm, 1 + 0.12 * Sin(1.5 * xm - zm), zm};
  EndFor
  For i In {0 : 3}
    next = i < 3 ? i + 1 : 0;
    Line(o + i + 1) = {o + i + 1, o + next + 1};
    Spline(o + i + 5) = {o + i + 5, o + i + 9, o + next + 5};
    Line(o + i + 9) = {o + i + 1, o + i + 5};
  EndFor
  Curve Loop(o + 1) = {o + 1, o + 2, o + 3, o + 4}; Plane Surface(o + 1) = {o + 1};
  Curve Loop(o + 2) = {o + 5, o + 6, o + 7, o + 8}; Surface(o + 2) = {o + 2};
  For i In {0 : 3}
    next = i < 3 ? i + 1 : 0;
    Curve Loop(o + i + 3) = {o + i + 1, o + next + 9, -(o + i + 5), -(o + i + 9)}; Plane Surface(o + i + 3) = {o + i + 3};
  EndFor
  Surface Loop(b + 1) = {o + 1 : o + 6}; Volume(b + 1) = {b + 1};
  Transfinite Curve {o + 1 : o + 12} = cells + 1;
  Transfinite Surface {o + 1 : o + 6}; Transfinite Volume {b + 1}; Recombine Surface {o + 1 : o + 6};
EndFor
Physical Volume("lower") = {1}; Physical Volume("upper") = {2};
Physical Surface("foot") = {1}; Physical Surface("top") = {101};
Physical Surface("joint_below") = {2}; Physical Surface("joint_above") = {102};
Physical Surface("left") = {6, 106}; Physical Surface("right") = {104}; Physical Surface("front") = {3, 103};
