// A base with cells, and a post that is its surface alone, of triangles and quadrilaterals; with hollow = 1 there is no volume in it.
SetFactory("OpenCASCADE");
DefineConstant[ hollow = 0 ];
Box(1) = {0, 0, 0, 4, 2, 1};
base() = Boundary{ Volume{1}; };
Box(2) = {0, 0, 1, 2, 2, 1};
post() = Boundary{ Volume{2}; };
If (hollow)
  Delete { Volume{2}; }
EndIf
Mesh.MeshSizeMax = 0.7;
Physical Volume("base") = {1};
Physical Surface("left") = {base(0)};
Physical Surface("front") = {base(2)};
Physical Surface("ground") = {base(4)};
Physical Surface("seat") = {base(5)};
Recombine Surface {post(5)};
Physical Surface("top") = {post(5)};
Physical Surface("foot") = {post(4)};
Physical Surface("sides") = {post(0), post(1), post(2), post(3)};
