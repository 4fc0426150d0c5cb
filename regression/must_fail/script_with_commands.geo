SystemCall "touch script_has_run";
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Volume("a") = {1};
