// Two concentric rings that share the nodes of r = 2, each n cells thick.
DefineConstant[n = 8];
Mesh.RecombineAll = 1; Mesh.ElementOrder = 2;
For i In {0 : 2}
  Point(1 + i) = {1 + i, 0, 0};
EndFor
Line(1) = {1, 2}; Line(2) = {2, 3};
Transfinite Curve{1, 2} = n + 1;
For i In {1 : 2}
  made() = Extrude{0, 0.25, 0} { Curve{i}; Layers{2}; Recombine; };
  surface(i) = made(1);
  top(i) = made(0);
  sides() += {made(2), made(3)};
EndFor
Physical Surface("liner") = {surface(1)};
Physical Surface("jacket") = {surface(2)};
Physical Curve("ends") = {1, 2, top(1), top(2)};
Physical Curve("bore") = {Curve In BoundingBox{0.9, -0.1, -0.1, 1.1, 0.4, 0.1}};
