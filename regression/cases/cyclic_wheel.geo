// A sixth of a wheel on a hollow shaft, radii 0.6, 1 and 2, with a tooth that leans; the cuts at 10 and 70 degrees have different
// meshes.
DefineConstant[ n = 4 ];
from = 10 * Pi / 180; to = 70 * Pi / 180; h = 1 / n;
Point(1) = {0, 0, 0};
Point(2) = {0.6 * Cos(from), 0.6 * Sin(from), 0, h}; Point(3) = {1 * Cos(from), 1 * Sin(from), 0, h};
Point(4) = {1 * Cos(to), 1 * Sin(to), 0, h}; Point(5) = {0.6 * Cos(to), 0.6 * Sin(to), 0, h};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(12) = {1 * Cos(from), 1 * Sin(from), 0, h}; Point(13) = {2 * Cos(from), 2 * Sin(from), 0, h};
Point(14) = {2 * Cos(30 * Pi / 180), 2 * Sin(30 * Pi / 180), 0, h}; Point(15) = {2.7 * Cos(42 * Pi / 180), 2.7 * Sin(42 * Pi / 180), 0, h};
Point(16) = {2.7 * Cos(50 * Pi / 180), 2.7 * Sin(50 * Pi / 180), 0, h}; Point(17) = {2 * Cos(48 * Pi / 180), 2 * Sin(48 * Pi / 180), 0, h};
Point(18) = {2 * Cos(to), 2 * Sin(to), 0, h}; Point(19) = {1 * Cos(to), 1 * Sin(to), 0, h};
Line(11) = {12, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 15}; Line(14) = {15, 16}; Line(15) = {16, 17};
Circle(16) = {17, 1, 18}; Line(17) = {18, 19}; Circle(18) = {19, 1, 12};
Curve Loop(11) = {11:18}; Plane Surface(11) = {11};
Transfinite Curve {1} = 3; Transfinite Curve {3} = 4; Transfinite Curve {11} = n + 1; Transfinite Curve {17} = n + 2;
Transfinite Curve {2, 4} = n + 1; Transfinite Curve {18} = n + 3;
Mesh.ElementOrder = 2;
Physical Surface("shaft") = {1};
Physical Surface("hub") = {11};
Physical Curve("shaft_cut_a") = {1};
Physical Curve("shaft_cut_b") = {3};
Physical Curve("shaft_rim") = {2};
Physical Curve("shaft_bore") = {4};
Physical Curve("hub_cut_a") = {11};
Physical Curve("hub_cut_b") = {17};
Physical Curve("hub_bore") = {18};
Physical Curve("flank") = {15};
