// A ninth of a fan wheel on its hollow shaft, mm: shaft radii 10 and 20, hub to radius 35, blade to 90, 4 thick, inclined by 30 degrees.
// The axis is z; the cuts lie at -20 and 20 degrees, and their meshes need not match.
SetFactory("OpenCASCADE");
DefineConstant[ h = 4, order = 2 ];
half = 20 * Pi / 180; stagger = 30 * Pi / 180; w = 30; e = 1e-3;
Cylinder(1) = {0, 0, 0, 0, 0, w, 35, 2 * half};
Cylinder(2) = {0, 0, 0, 0, 0, w, 20, 2 * half};
Cylinder(3) = {0, 0, -15, 0, 0, 55, 20, 2 * half};
Cylinder(4) = {0, 0, -15, 0, 0, 55, 10, 2 * half};
BooleanDifference(5) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
BooleanDifference(6) = { Volume{3}; Delete; }{ Volume{4}; Delete; };
Rotate {{0, 0, 1}, {0, 0, 0}, -half} { Volume{5, 6}; }
Box(7) = {30, -2, w / 2 - 12, 60, 4, 24};
Rotate {{1, 0, 0}, {0, 0, w / 2}, stagger} { Volume{7}; }
BooleanUnion(8) = { Volume{5}; Delete; }{ Volume{7}; Delete; };

c = Cos(half); s = Sin(half); y = 2 * Cos(stagger); z = w / 2 + 2 * Sin(stagger); dy = 12 * Sin(stagger); dz = 12 * Cos(stagger);
Physical Volume("shaft") = {6};
Physical Volume("wheel") = {8};
Physical Surface("wheel_cut_1") = Surface In BoundingBox {20 * c - e, -35 * s - e, -e, 35 * c + e, -20 * s + e, w + e};
Physical Surface("wheel_cut_2") = Surface In BoundingBox {20 * c - e, 20 * s - e, -e, 35 * c + e, 35 * s + e, w + e};
Physical Surface("shaft_cut_1") = Surface In BoundingBox {10 * c - e, -20 * s - e, -15 - e, 20 * c + e, -10 * s + e, 40 + e};
Physical Surface("shaft_cut_2") = Surface In BoundingBox {10 * c - e, 10 * s - e, -15 - e, 20 * c + e, 20 * s + e, 40 + e};
Physical Surface("shaft_end") = Surface In BoundingBox {0, -20, -15 - e, 20 + e, 20, -15 + e};
bore() = Surface In BoundingBox {20 * c - e, -20 * s - e, -e, 20 + e, 20 * s + e, w + e};
seat() = Surface In BoundingBox {20 * c - e, -20 * s - e, -15 - e, 20 + e, 20 * s + e, 40 + e};
seat() -= bore();
Physical Surface("wheel_bore") = bore();
Physical Surface("shaft_seat") = seat();
Physical Surface("flank") = Surface In BoundingBox {30, y - dy - e, z - dz - e, 90 + e, y + dy + e, z + dz + e};
Mesh.MeshSizeMax = h; Mesh.MeshSizeFromCurvature = 36;
Mesh.ElementOrder = order;
