SetFactory("OpenCASCADE");
Disk(1)={0,0,0,1,1};
Disk(2)={0,0,0,0.5,0.5};BooleanDifference(10)={Surface{1};Delete;}{Surface{2};Delete;};
Disk(3)={0,0,0,1.5,1.5};Disk(4)={0,0,0,1,1};BooleanDifference(20)={Surface{3};Delete;}{Surface{4};Delete;};
Rotate{{0,0,1},{0,0,0},0.37}{Surface{20};}
Physical Surface("in")={10};Physical Surface("out")={20};
p()=Boundary{Surface{10};};q()=Boundary{Surface{20};};
Physical Curve("c1")={p(0)};Physical Curve("c2")={p(1)};Physical Curve("d1")={q(0)};Physical Curve("d2")={q(1)};
MeshSize{PointsOf{Surface{10};}}=0.05;
MeshSize{PointsOf{Surface{20};}}=0.3;Mesh.MeshSizeExtendFromBoundary=1;Mesh.MeshSizeMin=0.001;
