// A wheel, R = 10 with a bore of 4, finer where it touches the road below.
R = 10; r = 4; fine = DefineNumber[0.06, Name "fine"];
Point(1) = {0, R, 0, 2};
Point(2) = {0, 0, 0, fine};
Point(3) = {R, R, 0, 3};
Point(4) = {0, 2 * R, 0, 3};
Point(5) = {-R, R, 0, 3};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Point(6) = {r, R, 0, 2}; Point(7) = {0, R + r, 0, 2}; Point(8) = {-r, R, 0, 2}; Point(9) = {0, R - r, 0, 2};
Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Circle(8) = {9, 1, 6};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};
Physical Surface("wheel") = {1};
Physical Curve("rim") = {1, 2, 3, 4};
Physical Curve("bore") = {5, 6, 7, 8};
