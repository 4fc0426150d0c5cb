// Two blocks of n x m x 2 cells over [0, 2] x [from, 2]. The upper one's bottom is z = 1 + 0.01 ((x - a)^2 + (y - b)^2), nearest at
// (a, b). With `parts: 2` there are two more over [0, 2] x [-2, from], which end where these begin.
DefineConstant[ n = 9, m = n, a = 1, b = 1, from = 0, parts = 1, order = 1, tri = 0 ];
Macro Body  // its first point p, y from y0 to y1, its bottom and top at the corners, whether the bottom is curved
  For k In {0 : 3}
    x = (k == 1 || k == 2) ? 2 : 0; y = k > 1 ? y1 : y0;
    Point(p + k) = {x, y, bottom[k]}; Point(p + 4 + k) = {x, y, top};
  EndFor
  For k In {0 : 3}  // edges of the bottom lie below their chords
    next = (k + 1) % 4; xm = k == 0 || k == 2 ? 1 : (k == 1 ? 2 : 0); ym = k == 1 || k == 3 ? (y0 + y1) / 2 : (k == 0 ? y0 : y1);
    sag = curved * 0.005 * (k == 0 || k == 2 ? 4 : (y1 - y0)^2);
    Point(p + 8 + k) = {xm, ym, (bottom[k] + bottom[next]) / 2 - sag};
    Bezier(p + k) = {p + k, p + 8 + k, p + next};
    Line(p + 4 + k) = {p + 4 + k, p + 4 + next};
    Line(p + 8 + k) = {p + k, p + 4 + k};
  EndFor
  Curve Loop(p) = {p, p + 1, p + 2, p + 3}; Surface(p) = {p};
  Curve Loop(p + 1) = {p + 4, p + 5, p + 6, p + 7}; Plane Surface(p + 1) = {p + 1};
  For k In {0 : 3}
    next = (k + 1) % 4;
    Curve Loop(p + 2 + k) = {p + k, p + 8 + next, -(p + 4 + k), -(p + 8 + k)}; Plane Surface(p + 2 + k) = {p + 2 + k};
  EndFor
  Surface Loop(p) = {p : p + 5}; Volume(p) = {p};
  Transfinite Curve{p, p + 2, p + 4, p + 6} = n + 1; Transfinite Curve{p + 1, p + 3, p + 5, p + 7} = m + 1;
  Transfinite Curve{p + 8 : p + 11} = 3;
  Transfinite Surface{p : p + 5}; Transfinite Volume{p};
  If (!tri) Recombine Surface{p : p + 5}; EndIf
Return
Macro Blocks  // from p: over y0 to y1
  bottom[] = {0, 0, 0, 0}; top = 1; curved = 0; Call Body;
  p += 100; top = 2; curved = 1;
  For k In {0 : 3}
    x = (k == 1 || k == 2) ? 2 : 0; y = k > 1 ? y1 : y0;
    bottom[k] = 1 + 0.01 * ((x - a)^2 + (y - b)^2);
  EndFor
  Call Body;
Return
p = 1; y0 = from; y1 = 2; Call Blocks;
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = 1;
Physical Volume("lower") = {1}; Physical Volume("upper") = {101};
floors[] = {1}; flats[] = {2}; crowns[] = {101}; roofs[] = {102};
If (parts == 2)
  p = 201; y0 = -2; y1 = from; Call Blocks;
  Physical Volume("lower_2") = {201}; Physical Volume("upper_2") = {301};
  floors[] += {201}; flats[] += {202}; crowns[] += {301}; roofs[] += {302};
  Physical Surface("lower_cut_2") = {205}; Physical Surface("upper_cut_2") = {305};
EndIf
Physical Surface("floor") = floors[]; Physical Surface("flat") = flats[]; Physical Surface("crowned") = crowns[];
Physical Surface("roof") = roofs[]; Physical Surface("lower_cut") = {3}; Physical Surface("upper_cut") = {103};
