// A roller of radius R between two plates, fine where it touches.
DefineConstant[ R = 10, h = 0.08, coarse = 2 ];
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 0;
Point(1) = {0, R, 0, coarse};
a = 0.1;
Point(2) = {-R * Sin(a), R - R * Cos(a), 0, h};
Point(3) = {R * Sin(a), R - R * Cos(a), 0, h};
Point(4) = {R, R, 0, coarse};
Point(5) = {R * Sin(a), R + R * Cos(a), 0, h};
Point(6) = {-R * Sin(a), R + R * Cos(a), 0, h};
Point(7) = {-R, R, 0, coarse};
For i In {0 : 5}
  Circle(1 + i) = {2 + i, 1, 2 + (i + 1) % 6};
EndFor
Curve Loop(1) = {1 : 6};
Plane Surface(1) = {1};
For k In {0 : 1}
  inner = k == 0 ? 0 : 2 * R;
  outer = k == 0 ? -8 : 2 * R + 8;
  p = 10 + 10 * k;
  Point(p) = {-12, inner, 0, coarse}; Point(p + 1) = {-1, inner, 0, h}; Point(p + 2) = {1, inner, 0, h};
  Point(p + 3) = {12, inner, 0, coarse}; Point(p + 4) = {12, outer, 0, coarse}; Point(p + 5) = {-12, outer, 0, coarse};
  For i In {0 : 5}
    Line(p + i) = {p + i, p + (i + 1) % 6};
  EndFor
  Curve Loop(2 + k) = {p : p + 5};
  Plane Surface(2 + k) = {2 + k};
EndFor
Physical Surface("roller") = {1};
Physical Surface("plates") = {2, 3};
Physical Curve("rim") = {1 : 6};
Physical Curve("floor") = {10 : 12};
Physical Curve("ceiling") = {20 : 22};
Physical Curve("bottom") = {14};
Physical Curve("top") = {24};
