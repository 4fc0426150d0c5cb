// Two blocks along a plane, two arcs of 30 degrees and radius R that bend against each other, and a plane again. The lower one has
// LOWER faces on each of these, the upper one UPPER; their corners lie exactly on the curve.
DefineConstant[ R = {0.6, Name "radius"}, LOWER = {2, Name "faces an arc of the lower block"}, UPPER = {3, Name "and of the upper one"} ];
S = R * Sin(Pi / 6); C = R * Cos(Pi / 6);
For b In {0 : 1}
  n = (b == 0) ? LOWER : UPPER;
  far = (b == 0) ? -0.6 : 0.6;
  p = newp; l = newl; s = news;
  For k In {0 : 4 * n}
    u = k / n;  // from 0 to 4: the plane, the arcs, the plane
    a = (u < 2 ? u - 1 : 3 - u) * Pi / 6;
    x = (u < 1) ? u * (0.5 - S) : (u < 2) ? 0.5 - S + R * Sin(a) : (u < 3) ? 0.5 + S - R * Sin(a) : 0.5 + S + (u - 3) * (0.5 - S);
    y = (u < 1) ? C - R : (u < 2) ? C - R * Cos(a) : (u < 3) ? R * Cos(a) - C : R - C;
    Point(p + 2 * k) = {x, y, 0}; Point(p + 2 * k + 1) = {x, far, 0};
    Line(l + 3 * k) = {p + 2 * k, p + 2 * k + 1};
    Transfinite Curve {l + 3 * k} = 4;
  EndFor
  near[] = {}; back[] = {}; all[] = {};
  For k In {0 : 4 * n - 1}
    Line(l + 3 * k + 1) = {p + 2 * k, p + 2 * k + 2}; Line(l + 3 * k + 2) = {p + 2 * k + 1, p + 2 * k + 3};
    Transfinite Curve {l + 3 * k + 1, l + 3 * k + 2} = 2;
    Curve Loop(s + k) = {l + 3 * k + 1, l + 3 * k + 3, -(l + 3 * k + 2), -(l + 3 * k)};
    Plane Surface(s + k) = {s + k};
    Transfinite Surface {s + k}; Recombine Surface {s + k};
    near[] += l + 3 * k + 1; back[] += l + 3 * k + 2; all[] += s + k;
  EndFor
  If (b == 0)
    Physical Surface("lower") = {all[]}; Physical Curve("base") = {back[]}; Physical Curve("under") = {near[]};
  Else
    Physical Surface("upper") = {all[]}; Physical Curve("top") = {back[]}; Physical Curve("over") = {near[]};
  EndIf
EndFor
