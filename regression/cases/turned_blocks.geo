// A block on one of other cells, turned by DEG about the origin.
Geometry.AutoCoherence = 0;
DefineConstant[ DEG = 0 ];
Point(1) = {0,0,0}; Point(2) = {10,0,0}; Point(3) = {10,4,0}; Point(4) = {0,4,0};
Point(5) = {0,4,0}; Point(6) = {10,4,0}; Point(7) = {10,8,0}; Point(8) = {0,8,0};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Line(5) = {5,6}; Line(6) = {6,7}; Line(7) = {7,8}; Line(8) = {8,5};
Curve Loop(1) = {1,2,3,4}; Curve Loop(2) = {5,6,7,8}; Plane Surface(1) = {1}; Plane Surface(2) = {2};
Rotate {{0,0,1},{0,0,0},DEG*Pi/180} { Surface{1,2}; }
Transfinite Curve {1,3} = 9; Transfinite Curve {2,4,6,8} = 5; Transfinite Curve {5,7} = 7;
Transfinite Surface {1,2}; Recombine Surface {1,2}; Mesh.ElementOrder = 2;
Physical Surface("a") = {1}; Physical Surface("c") = {2};
Physical Curve("a.ymin") = {1}; Physical Curve("a.ymax") = {3};
Physical Curve("c.xmin") = {8}; Physical Curve("c.ymin") = {5}; Physical Curve("c.ymax") = {7};
