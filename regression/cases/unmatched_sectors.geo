// A ninth of a ring in another one, radii 1, 2, 3, one high, between z-planes; the cells along the edges
// of the cut at 40 degrees grow, those at 0 are alike.
DefineConstant[ n = 6, m = 8, high = 4, grade = 1.25, order = 1 ];
to = 40 * Pi / 180;
Point(1) = {0, 0, 0}; Point(2) = {0, 0, 1};
Macro Ring  // from p: inner and outer radius, cells along it
  For k In {0 : 1}
    Point(p + 4 * k) = {inner, 0, k}; Point(p + 4 * k + 1) = {outer, 0, k};
    Point(p + 4 * k + 2) = {outer * Cos(to), outer * Sin(to), k}; Point(p + 4 * k + 3) = {inner * Cos(to), inner * Sin(to), k};
    q = p + 4 * k;
    Line(q) = {q, q + 1}; Circle(q + 1) = {q + 1, 1 + k, q + 2}; Line(q + 2) = {q + 2, q + 3}; Circle(q + 3) = {q + 3, 1 + k, q};
    Curve Loop(p + k) = {q : q + 3}; Plane Surface(p + k) = {p + k};
    Transfinite Curve {q, q + 2} = 4; Transfinite Curve {q + 1, q + 3} = cells + 1;
  EndFor
  For k In {0 : 3}
    Line(p + 8 + k) = {p + k, p + 4 + k};
    Transfinite Curve {p + 8 + k} = high + 1 Using Progression (k < 2 ? 1 : grade);
  EndFor
  For k In {0 : 3}
    next = (k + 1) % 4;
    Curve Loop(p + 2 + k) = {p + k, p + 8 + next, -(p + 4 + k), -(p + 8 + k)};
    If (k % 2)
      Surface(p + 2 + k) = {p + 2 + k};
    Else
      Plane Surface(p + 2 + k) = {p + 2 + k};
    EndIf
  EndFor
  Surface Loop(p) = {p : p + 5}; Volume(p) = {p};
  Transfinite Surface {p : p + 5}; Recombine Surface {p : p + 5}; Transfinite Volume {p};
Return
p = 20; inner = 1; outer = 2; cells = n; Call Ring;
p = 40; inner = 2; outer = 3; cells = m; Call Ring;
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = 1;
Physical Volume("hub") = {20}; Physical Volume("ring") = {40};
Physical Surface("ends") = {20, 21, 40, 41};
Physical Surface("hub_0") = {22}; Physical Surface("rim") = {23}; Physical Surface("hub_1") = {24};
Physical Surface("ring_0") = {42}; Physical Surface("ring_1") = {44}; Physical Surface("bore") = {45};
