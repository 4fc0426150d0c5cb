// Two blocks 2 x 2 x 1 of n x n x 2 cells. The upper one's bottom is z = 1 + 0.04 (((x - a) / 2)^2 + ((y - b) / 2)^2), nearest at (a, b).
DefineConstant[ n = 9, a = 1, b = 1, order = 1, tri = 0 ];
Macro Body  // its first point p, its bottom and top at the corners, and by how much the edges of its bottom lie below their chords
  For k In {0 : 3}
    x = (k == 1 || k == 2) ? 2 : 0; y = k > 1 ? 2 : 0;
    Point(p + k) = {x, y, bottom[k]}; Point(p + 4 + k) = {x, y, top};
  EndFor
  For k In {0 : 3}
    next = (k + 1) % 4; xm = k == 0 || k == 2 ? 1 : (k == 1 ? 2 : 0); ym = k == 1 || k == 3 ? 1 : (k == 0 ? 0 : 2);
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
  Transfinite Curve{p : p + 7} = n + 1; Transfinite Curve{p + 8 : p + 11} = 3;
  Transfinite Surface{p : p + 5}; Transfinite Volume{p};
  If (!tri) Recombine Surface{p : p + 5}; EndIf
Return
p = 1; bottom[] = {0, 0, 0, 0}; top = 1; sag = 0; Call Body;
p = 101; top = 2; sag = 0.02;
For k In {0 : 3}
  x = (k == 1 || k == 2) ? 2 : 0; y = k > 1 ? 2 : 0;
  bottom[k] = 1 + 0.04 * (((x - a) / 2)^2 + ((y - b) / 2)^2);
EndFor
Call Body;
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = 1;
Physical Volume("lower") = {1}; Physical Volume("upper") = {101};
Physical Surface("floor") = {1}; Physical Surface("flat") = {2}; Physical Surface("crowned") = {101}; Physical Surface("roof") = {102};
