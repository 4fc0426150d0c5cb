// A quarter of a ring, cells of second order.
DefineConstant[n = 12];
Point(1)={1,0,0};Point(2)={2,0,0};Point(3)={0,2,0};Point(4)={0,1,0};Point(5)={0,0,0};
Line(1)={1,2};Circle(2)={2,5,3};Line(3)={3,4};Circle(4)={4,5,1};Curve Loop(1)={1,2,3,4};Plane Surface(1)={1};
Transfinite Curve{1,3}=n+1;Transfinite Curve{2,4}=2*n+1;Transfinite Surface{1};Recombine Surface{1};Mesh.ElementOrder=2;
Physical Surface("ring")={1};Physical Curve("bore")={4};Physical Curve("along_x")={1};Physical Curve("along_y")={3};Physical Curve("skin")={2};
