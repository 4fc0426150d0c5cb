// A sector of a ring, of 45 degrees, or several in a row as one body; the last third of each is loaded at the bore.
DefineConstant[sectors = 1, foot = 0];  // foot: that third of the rim alone, which ends at one cut
Point(1) = {5, 0, 0}; Point(2) = {10, 0, 0};
Line(1) = {1, 2};
Transfinite Curve {1} = 5;
cut = 1; loaded[] = {}; rim[] = {}; ring[] = {};
For k In {1 : sectors}
  a[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 6} { Curve{cut}; Layers{4}; Recombine; };
  b[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 12} { Curve{a[0]}; Layers{2}; Recombine; };
  cut = b[0];
  ring[] += {a[1], b[1]}; loaded[] += {b[3]}; rim[] += {b[2]};
  If (foot == 0)
    rim[] += {a[2]};
  EndIf
EndFor
Coherence;
Physical Surface("ring") = {ring[]};
Physical Curve("loaded") = {loaded[]};
Physical Curve("rim") = {rim[]};
If (sectors == 1)
  Physical Curve("low") = {1};
  Physical Curve("high") = {cut};
EndIf
