// A quarter of a square bolt, cut in two along a pyramid: z = 0.4 (x + y).
Point(1) = {0, 0, -2}; Point(2) = {1, 0, -2}; Point(3) = {1, 1, -2}; Point(4) = {0, 1, -2};
For part In {0:1}
  Point(10 + 10 * part) = {0, 0, 0}; Point(11 + 10 * part) = {1, 0, 0.4}; Point(12 + 10 * part) = {1, 1, 0.8}; Point(13 + 10 * part) = {0, 1, 0.4};
EndFor
Point(31) = {0, 0, 2}; Point(32) = {1, 0, 2}; Point(33) = {1, 1, 2}; Point(34) = {0, 1, 2};
Macro Brick
  l = newc;
  For k In {0:3}
    Line(l + k) = {below[k], below[(k + 1) % 4]}; Line(l + 4 + k) = {above[k], above[(k + 1) % 4]}; Line(l + 8 + k) = {below[k], above[k]};
  EndFor
  s = news;
  Curve Loop(s) = {l, l + 1, l + 2, l + 3}; Plane Surface(s) = {s};
  Curve Loop(s + 1) = {l + 4, l + 5, l + 6, l + 7}; Plane Surface(s + 1) = {s + 1};
  For k In {0:3}
    Curve Loop(s + 2 + k) = {l + k, l + 8 + (k + 1) % 4, -(l + 4 + k), -(l + 8 + k)}; Plane Surface(s + 2 + k) = {s + 2 + k};
  EndFor
  v = newv; Surface Loop(v) = {s:s + 5}; Volume(v) = {v};
  Transfinite Curve{l:l + 7} = 4; Transfinite Curve{l + 8:l + 11} = 5;
  Transfinite Surface{s:s + 5}; Recombine Surface{s:s + 5}; Transfinite Volume{v};
Return
below[] = {1, 2, 3, 4}; above[] = {10, 11, 12, 13}; Call Brick;
s0 = s; v0 = v;
below[] = {20, 21, 22, 23}; above[] = {31, 32, 33, 34}; Call Brick;
s1 = s; v1 = v;
Physical Volume("shank") = {v0}; Physical Volume("head") = {v1};
Physical Surface("foot") = {s0}; Physical Surface("under") = {s0 + 1}; Physical Surface("over") = {s1}; Physical Surface("top") = {s1 + 1};
Physical Surface("across_y") = {s0 + 2, s1 + 2}; Physical Surface("across_x") = {s0 + 5, s1 + 5};
