// A pad on a seat of the same outline, meshed with different tetrahedra.
SetFactory("OpenCASCADE");
Box(1) = {2, 0, 0, 1, 1, 0.5};
Box(2) = {2, 0, 0.5, 1, 1, 1};
MeshSize{PointsOf{Volume{1};}} = 0.4;
MeshSize{PointsOf{Volume{2};}} = 0.3;
Physical Volume("seat") = {1};
Physical Volume("pad") = {2};
Physical Surface("ground") = {5};
Physical Surface("seat_face") = {6};
Physical Surface("pad_foot") = {11};
Physical Surface("pad.top") = {12};
