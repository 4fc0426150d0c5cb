// Plates 0.05 thick, of faces as long as 0.2; each one's outside is one boundary, but for its left end.
n = 4; thick = 0.05;
For i In {0:n - 1}
  p = newp; y = i * thick; faces = 5 + i % 2;
  Point(p) = {0, y, 0}; Point(p + 1) = {1, y, 0}; Point(p + 2) = {1, y + thick, 0}; Point(p + 3) = {0, y + thick, 0};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  Transfinite Curve {l, l + 2} = faces + 1; Transfinite Curve {l + 1, l + 3} = 2;
  Curve Loop(i + 1) = {l, l + 1, l + 2, l + 3}; Plane Surface(i + 1) = {i + 1};
  Transfinite Surface {i + 1}; Recombine Surface {i + 1};
  Physical Surface(Sprintf("plate%g", i + 1)) = {i + 1};
  Physical Curve(Sprintf("skin%g", i + 1)) = {l, l + 1, l + 2};
  Physical Curve(Sprintf("end%g", i + 1)) = {l + 3};
  If (i == 0)
    Physical Curve("base") = {l};
  EndIf
  If (i == n - 1)
    Physical Curve("top") = {l + 2};
  EndIf
EndFor
