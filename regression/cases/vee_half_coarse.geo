// A cylinder of radius 1 in a V of 45 degrees. One flank, and the rim that it meets, have fine faces; the other flank has faces of size h.
DefineConstant[ h = 0.15, n = 60 ];
Mesh.ElementOrder = 2;
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {0, 1, 0}; Point(4) = {-1, 0, 0}; Point(5) = {0, -1, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
s = Sqrt(2);  // the V's apex lies sqrt(2) under the axis
For k In {0 : 1}
  d = k == 0 ? -1 : 1;
  p = newp; Point(p) = {0, -s, 0}; Point(p + 1) = {d * 1.5, -s + 1.5, 0}; Point(p + 2) = {d * 1.5, -s - 1, 0}; Point(p + 3) = {0, -s - 1, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  Curve Loop(10 + k) = {l, l + 1, l + 2, l + 3}; Plane Surface(10 + k) = {10 + k};
  face(k) = l; base(k) = l + 2; sides(2 * k) = l + 1; sides(2 * k + 1) = l + 3;
EndFor
Transfinite Curve {face(0)} = n + 1; Transfinite Curve {3} = 3 * n / 4 + 1;
Transfinite Curve {face(1)} = 2.12 / h; Transfinite Curve {1, 2, 4} = 1.57 / h;
Transfinite Curve {base(), sides()} = 10;
Physical Surface("cylinder") = {1}; Physical Surface("vee") = {10, 11};
Physical Curve("upper_rim") = {1, 2}; Physical Curve("rim") = {3, 4};
Physical Curve("flanks") = {face(0), face(1)}; Physical Curve("base") = {base(0), base(1)};
