// A pin of exactly the hole's radius, in cells of every kind; the meshes of the two bodies do not match.
//   kind: 0 tetrahedra (2D: triangles), 1 prisms, 2 hexahedra (2D: quadrilaterals); order; incomplete: 1 leaves out the nodes
//   inside faces; plane: 1 the section alone; analytic: 0 splines for the pin, so that the geometry is two surfaces
SetFactory("OpenCASCADE");
DefineConstant[ kind = 0, order = 1, incomplete = 0, plane = 0, analytic = 1, r = 10 ];
Rectangle(1) = {-25, -25, 0, 50, 50};
Disk(2) = {0, 0, 0, r};
BooleanDifference(3) = {Surface{1}; Delete;}{Surface{2}; Delete;};
If(analytic)
  Circle(100) = {0, 0, 0, r, 0.3, 0.3 + 2 * Pi};
Else
  For i In {0:39}
    Point(1000 + i) = {r * Cos(2 * Pi * i / 40), r * Sin(2 * Pi * i / 40), 0};
    c[i] = 1000 + i;
  EndFor
  c[40] = 1000;
  Spline(100) = c[];
EndIf
Curve Loop(100) = {100};
Plane Surface(4) = {100};
MeshSize{:} = 7;
MeshSize{PointsOf{Surface{4};}} = 5;
If(kind == 2)
  Mesh.RecombineAll = 1;
  Mesh.RecombinationAlgorithm = 2;
EndIf
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = incomplete;
If(plane)
  Physical Surface("plate") = {3};
  Physical Surface("pin") = {4};
  Physical Curve("hole") = {Curve In BoundingBox{-r - 1, -r - 1, -1, r + 1, r + 1, 1}};
  Physical Curve("hole") -= {100};
  Physical Curve("shank") = {100};
  Physical Curve("left") = {Curve In BoundingBox{-26, -26, -1, -24, 26, 1}};
Else
  If(kind == 0)
    a[] = Extrude{0, 0, 12}{Surface{3};};
    b[] = Extrude{0, 0, 12}{Surface{4};};
  Else
    a[] = Extrude{0, 0, 12}{Surface{3}; Layers{3}; Recombine;};
    b[] = Extrude{0, 0, 12}{Surface{4}; Layers{4}; Recombine;};
  EndIf
  Physical Volume("plate") = {a[1]};
  Physical Volume("pin") = {b[1]};
  Physical Surface("shank") = {b[2]};
  Physical Surface("hole") = {Surface In BoundingBox{-r - 1, -r - 1, -1, r + 1, r + 1, 13}};
  Physical Surface("hole") -= {b[]};
  Physical Surface("hole") -= {4};
  Physical Surface("left") = {Surface In BoundingBox{-26, -26, -1, -24, 26, 13}};
  Physical Surface("end") = {4};
EndIf
