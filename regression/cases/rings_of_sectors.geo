// A ninth of a ring in another one, radii 1, 2, 3, whose cells do not match; the cuts are at 0 and 40 degrees.
DefineConstant[ n = 8, m = 11, radial = 3, order = 1 ];
to = 40 * Pi / 180;
Point(1) = {0, 0, 0};
Macro Ring  // from p: inner and outer radius, cells along it
  Point(p) = {inner, 0, 0}; Point(p + 1) = {outer, 0, 0};
  Point(p + 2) = {outer * Cos(to), outer * Sin(to), 0}; Point(p + 3) = {inner * Cos(to), inner * Sin(to), 0};
  Line(p) = {p, p + 1}; Circle(p + 1) = {p + 1, 1, p + 2}; Line(p + 2) = {p + 2, p + 3}; Circle(p + 3) = {p + 3, 1, p};
  Curve Loop(p) = {p : p + 3}; Plane Surface(p) = {p};
  Transfinite Curve {p, p + 2} = radial + 1; Transfinite Curve {p + 1, p + 3} = cells + 1;
  Transfinite Surface {p}; Recombine Surface {p};
Return
p = 10; inner = 1; outer = 2; cells = n; Call Ring;
p = 20; inner = 2; outer = 3; cells = m; Call Ring;
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = 1;
Physical Surface("hub") = {10}; Physical Surface("ring") = {20};
Physical Curve("hub_0") = {10}; Physical Curve("rim") = {11}; Physical Curve("hub_1") = {12};
Physical Curve("ring_0") = {20}; Physical Curve("ring_1") = {22}; Physical Curve("bore") = {23};
