// flange.step with names, in tetrahedra of second order of size h, of half of it about the bolts. The two parts of a bolt share the nodes of the cut, as
// CalculiX wants it; in Mortise each body has its own.
DefineConstant[ h = 10 ];
SetFactory("OpenCASCADE");
v() = ShapeFromFile("flange.step");
BooleanFragments{ Volume{v(0)}; Delete; }{ Volume{v({2 : 4})}; Delete; }
Geometry.AutoCoherence = 0;  // what touches elsewhere stays apart

e = 0.01;
at_top() = Surface In BoundingBox {-90 - e, -e, 18 - e, 90 + e, 90 + e, 18 + e};
at_joint() = Surface In BoundingBox {-90 - e, -e, -e, 90 + e, 90 + e, e};
Physical Volume("lower") = v(0);
Physical Volume("upper") = v(1);
For k In {1 : 3}
  Physical Volume(Sprintf("bolt_%g", k)) = v(1 + k);
  of_bolt() = Boundary { Volume{v(1 + k)}; };
  x = 70 * Cos((60 * k - 30) * Pi / 180);
  y = 70 * Sin((60 * k - 30) * Pi / 180);
  under() = Surface In BoundingBox {x - 9.5 - e, y - 9.5 - e, 18 - e, x + 9.5 + e, y + 9.5 + e, 18 + e};
  Physical Surface(Sprintf("head_%g", k)) = under();
  Physical Surface(Sprintf("cut_%g", k)) = Surface In BoundingBox {x - 6 - e, y - 6 - e, 9 - e, x + 6 + e, y + 6 + e, 9 + e};
  at_top() -= under();
EndFor
of_lower() = Boundary { Volume{v(0)}; };
of_upper() = Boundary { Volume{v(1)}; };
lower_joint() = at_joint();
lower_joint() -= of_upper();
upper_joint() = at_joint();
upper_joint() -= of_lower();
Physical Surface("seat") = at_top();
Physical Surface("lower_joint") = lower_joint();
Physical Surface("upper_joint") = upper_joint();
Physical Surface("symmetry") = Surface In BoundingBox {-90 - e, -e, -30 - e, 90 + e, e, 60 + e};
Physical Surface("foot") = Surface In BoundingBox {-90 - e, -e, -30 - e, 90 + e, 90 + e, -30 + e};
Physical Surface("end") = Surface In BoundingBox {-50 - e, -e, 60 - e, 50 + e, 50 + e, 60 + e};

MeshSize { PointsOf { Volume{:}; } } = h;
For k In {1 : 3}
  MeshSize { PointsOf { Volume{v(1 + k)}; } } = h / 2;
EndFor
MeshSize { Point In BoundingBox {-77, 28, -e, 77, 77, 18 + e} } = h / 2;  // the holes and the shanks
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 1;
