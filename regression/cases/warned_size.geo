// Four cells along each edge, whatever size is asked for.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Transfinite Curve {:} = 5;
Transfinite Surface {:};
Transfinite Volume {:};
Physical Volume("box") = {1};
Physical Surface("foot") = {5};
Physical Surface("head") = {6};
