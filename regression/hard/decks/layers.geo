// A body of two layers that share nodes, the upper volume called skin, the lower core; below it, with nodes of its own, an anvil.
SetFactory("OpenCASCADE");
DefineConstant[n = 3, anvil = 1];
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, 1, 1, 1, 1};
Coherence;
Transfinite Curve{:} = n + 1;
Physical Volume("core") = {1};
Physical Volume("skin") = {2};
Physical Surface("foot") = {Surface In BoundingBox{-0.1, -0.1, -0.1, 1.1, 1.1, 0.1}};
Physical Surface("seam") = {Surface In BoundingBox{-0.1, -0.1, 0.9, 1.1, 1.1, 1.1}};
Physical Surface("top") = {Surface In BoundingBox{-0.1, -0.1, 1.9, 1.1, 1.1, 2.1}};
Physical Surface("left") = {Surface In BoundingBox{-0.1, -0.1, -0.1, 0.1, 1.1, 2.1}};
Physical Surface("right") = {Surface In BoundingBox{0.9, -0.1, -0.1, 1.1, 1.1, 2.1}};
If (anvil)
  Box(3) = {0, 0, -1, 1, 1, 1};
  MeshSize{PointsOf{Volume{3};}} = 0.5;
  Physical Volume("anvil") = {3};
  Physical Surface("ground") = {Surface In BoundingBox{-0.1, -0.1, -1.1, 1.1, 1.1, -0.9}};
  below() = Surface In BoundingBox{-0.1, -0.1, -0.1, 1.1, 1.1, 0.1};
  Physical Surface("anvil_top") = {below(1)};
EndIf
