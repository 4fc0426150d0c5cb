// Two rings of prisms, the upper one from radius 5 to 10 on the lower one from 4 to 12.
DefineConstant[ h = 3, order = 2 ];
SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 10}; Disk(2) = {0, 0, 0, 5};
up() = BooleanDifference{ Surface{1}; Delete; }{ Surface{2}; Delete; };
Disk(11) = {0, 0, 0, 12}; Disk(12) = {0, 0, 0, 4};
low() = BooleanDifference{ Surface{11}; Delete; }{ Surface{12}; Delete; };
u() = Extrude {0, 0, 4} { Surface{up()}; Layers{1}; };
l() = Extrude {0, 0, -4} { Surface{low()}; Layers{1}; };
Physical Volume("up") = {u(1)}; Physical Volume("low") = {l(1)};
Physical Surface("uf") = {up()}; Physical Surface("top") = {u(0)};
Physical Surface("lf") = {low()}; Physical Surface("bot") = {l(0)};
Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h;
Mesh.ElementOrder = order; Mesh.SecondOrderIncomplete = 1;
