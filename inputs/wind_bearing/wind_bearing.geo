// Two-row cylindrical roller bearing of 73 bodies: inner ring, outer ring with flanges, cage, 2 x Z rollers; all hexahedra, and every node of the
// crowned rollers on the profile. Dimensions like those of a bearing 300 x 420 x 118 of series 49. Axis z, load downwards (-y), the first roller at the bottom.
DefineConstant[ half = 0 ];                        // 1: only z >= 0, one row, the plane z = 0 is `symmetry`
DefineConstant[ Z = 35 ];                          // rollers of a row
DefineConstant[ bore = 150, F = 170, OD = 210 ];   // radii: bore, inner raceway, outside
DefineConstant[ R = 13, l = 32, row = 27 ];        // rollers: radius, length; |z| of their middle
DefineConstant[ B = 118 ];                         // width of the rings
DefineConstant[ clearance = 0 ];                   // Pd, on the diameter
DefineConstant[ crown = 0, logarithmic = 1 ];      // drop of a roller's radius at its ends; profile: logarithmic or (0) circular
DefineConstant[ flange = 8, play = 0.05 ];         // height of the outer ring's flanges; axial play of a roller at each end
DefineConstant[ C1 = 178, C2 = 187.5, pocket = 0.3, cage = 104 ]; // cage: radii, gap round a roller, width
DefineConstant[ m = 6, nri = 3, nro = 3 ];         // cells of the rings: along a sector, through the inner ring, through the outer ring
DefineConstant[ nz = 6, nf = 3, nh = 2 ];          // cells along a roller, along an outer flange, along half of the middle flange
DefineConstant[ na = 6, nl = 2 ];                  // cells of a roller: round a quarter, from its core out
DefineConstant[ mp = 6, mb = 2, nc = 2 ];          // cells of the cage: along a pocket, across a bar, through its thickness
Geometry.OldNewReg = 0; Geometry.AutoCoherence = 0;
DefineConstant[ order = 1 ];                       // 2: cells of second order
Mesh.ElementOrder = order;

pitch = F + R + clearance / 4;                     // the play is shared by both sides of a roller
O = F + 2 * R + clearance / 2;                     // outer raceway
sector = 2 * Pi / Z;

// A body of revolution cut into blocks of hexahedra: angles(j * nt + i) of the cuts at radius j, radii(), levels() along z; present((k * nj + j) * nt + i) tells which blocks
// are there; ct(), cr(), cz(): cells along each. Fills volumes(), and by block index fr(), fz(), ft() with the faces at constant radius, level and angle (0: none).
Macro Tube
  nt = #ct(); nj = #cr(); nk = #cz();
  axis() = {}; P() = {}; arc() = {}; radial() = {}; axial() = {};
  For k In {0 : nk}
    axis(k) = newp; Point(axis(k)) = {0, 0, levels(k)};
    For j In {0 : nj}
      For i In {0 : nt - 1}
        q = newp; Point(q) = {radii(j) * Cos(angles(j * nt + i)), radii(j) * Sin(angles(j * nt + i)), levels(k)};
        P((k * (nj + 1) + j) * nt + i) = q;
      EndFor
    EndFor
  EndFor
  For k In {0 : nk}
    For j In {0 : nj}
      For i In {0 : nt - 1}
        a = (k * (nj + 1) + j) * nt;
        c = newl; Circle(c) = {P(a + i), axis(k), P(a + (i + 1) % nt)}; Transfinite Curve {c} = ct(i) + 1;
        arc(a + i) = c;
        If (j < nj)
          c = newl; Line(c) = {P(a + i), P(a + nt + i)}; Transfinite Curve {c} = cr(j) + 1;
          radial(a + i) = c;
        Else
          radial(a + i) = 0;
        EndIf
        If (k < nk)
          c = newl; Line(c) = {P(a + i), P(a + (nj + 1) * nt + i)}; Transfinite Curve {c} = cz(k) + 1;
          axial(a + i) = c;
        EndIf
      EndFor
    EndFor
  EndFor
  fz() = {}; fr() = {}; ft() = {}; volumes() = {};
  For k In {0 : nk}
    For j In {0 : nj}
      For i In {0 : nt - 1}
        a = (k * (nj + 1) + j) * nt; up = (nj + 1) * nt; n = (i + 1) % nt;
        here = 0; below = 0; inner = 0; before = 0;
        If (k < nk && j < nj)
          here = present((k * nj + j) * nt + i); before = present((k * nj + j) * nt + (i + nt - 1) % nt);
        EndIf
        If (k > 0 && j < nj)
          below = present(((k - 1) * nj + j) * nt + i);
        EndIf
        If (k < nk && j > 0)
          inner = present((k * nj + j - 1) * nt + i);
        EndIf
        s = 0;
        If (here + below > 0)
          s = newll; Curve Loop(s) = {radial(a + i), arc(a + nt + i), -radial(a + n), -arc(a + i)}; Plane Surface(s) = {s};
        EndIf
        fz(a + i) = s;
        t = 0;
        If (here + inner > 0)
          t = newll; Curve Loop(t) = {arc(a + i), axial(a + n), -arc(a + up + i), -axial(a + i)}; Surface(t) = {t};
        EndIf
        fr(a + i) = t;
        u = 0;
        If (here + before > 0)
          u = newll; Curve Loop(u) = {radial(a + i), axial(a + nt + i), -radial(a + up + i), -axial(a + i)}; Plane Surface(u) = {u};
        EndIf
        ft(a + i) = u;
      EndFor
    EndFor
  EndFor
  For k In {0 : nk - 1}
    For j In {0 : nj - 1}
      For i In {0 : nt - 1}
        a = (k * (nj + 1) + j) * nt; up = (nj + 1) * nt; n = (i + 1) % nt;
        If (present((k * nj + j) * nt + i))
          v = newv; Surface Loop(v) = {fz(a + i), fz(a + up + i), fr(a + i), fr(a + nt + i), ft(a + i), ft(a + n)}; Volume(v) = {v};
          volumes() += v;
        EndIf
      EndFor
    EndFor
  EndFor
Return

// A roller of `length` from z0 up, its middle at z0 + length / 2, axis in the direction b from the middle of the bearing. Section: a square core and four
// sides. Crowned: one slice a layer of cells, so that all nodes are on the profile. Appends to roller_volumes(), side_faces(), lower_ends(), upper_ends().
Macro Roller
  slices = 1;
  If (crown > 0)
    slices = nz;
  EndIf
  Q() = {}; S() = {}; edge() = {}; rim() = {}; spoke() = {}; q_up() = {}; s_up() = {}; core() = {}; side() = {};
  x0 = pitch * Cos(b); y0 = pitch * Sin(b);
  For k In {0 : slices}
    z = z0 + k * l / slices; t = 2 * k / slices - 1; drop = crown * t * t;
    If (logarithmic)
      drop = crown * Log(1 - 0.95 * t * t) / Log(1 - 0.95);
    EndIf
    o = newp; Point(o) = {x0, y0, z};
    For n In {0 : 3}
      a = b + Pi / 4 + n * Pi / 2;
      q = newp; Point(q) = {x0 + 0.5 * R * Cos(a), y0 + 0.5 * R * Sin(a), z}; Q(4 * k + n) = q;
      q = newp; Point(q) = {x0 + (R - drop) * Cos(a), y0 + (R - drop) * Sin(a), z}; S(4 * k + n) = q;
    EndFor
    For n In {0 : 3}
      c = newl; Line(c) = {Q(4 * k + n), Q(4 * k + (n + 1) % 4)}; Transfinite Curve {c} = na + 1; edge(4 * k + n) = c;
      c = newl; Circle(c) = {S(4 * k + n), o, S(4 * k + (n + 1) % 4)}; Transfinite Curve {c} = na + 1; rim(4 * k + n) = c;
      c = newl; Line(c) = {Q(4 * k + n), S(4 * k + n)}; Transfinite Curve {c} = nl + 1; spoke(4 * k + n) = c;
    EndFor
    c = newll; Curve Loop(c) = {edge(4 * k), edge(4 * k + 1), edge(4 * k + 2), edge(4 * k + 3)}; Plane Surface(c) = {c}; core(k) = c;
    For n In {0 : 3}
      c = newll; Curve Loop(c) = {spoke(4 * k + n), rim(4 * k + n), -spoke(4 * k + (n + 1) % 4), -edge(4 * k + n)}; Plane Surface(c) = {c}; side(4 * k + n) = c;
    EndFor
  EndFor
  lower_ends() += {core(0), side(0), side(1), side(2), side(3)};
  upper_ends() += {core(slices), side(4 * slices), side(4 * slices + 1), side(4 * slices + 2), side(4 * slices + 3)};
  For k In {0 : slices - 1}
    For n In {0 : 3}
      c = newl; Line(c) = {Q(4 * k + n), Q(4 * k + 4 + n)}; Transfinite Curve {c} = nz / slices + 1; q_up(n) = c;
      c = newl; Line(c) = {S(4 * k + n), S(4 * k + 4 + n)}; Transfinite Curve {c} = nz / slices + 1; s_up(n) = c;
    EndFor
    For n In {0 : 3}
      e = (n + 1) % 4;
      c = newll; Curve Loop(c) = {edge(4 * k + n), q_up(e), -edge(4 * k + 4 + n), -q_up(n)}; Plane Surface(c) = {c}; flat(n) = c;
      c = newll; Curve Loop(c) = {rim(4 * k + n), s_up(e), -rim(4 * k + 4 + n), -s_up(n)}; Surface(c) = {c}; round(n) = c; side_faces() += c;
      c = newll; Curve Loop(c) = {spoke(4 * k + n), s_up(n), -spoke(4 * k + 4 + n), -q_up(n)}; Plane Surface(c) = {c}; web(n) = c;
    EndFor
    v = newv; Surface Loop(v) = {core(k), core(k + 1), flat(0), flat(1), flat(2), flat(3)}; Volume(v) = {v}; roller_volumes() += v;
    For n In {0 : 3}
      v = newv; Surface Loop(v) = {side(4 * k + n), side(4 * k + 4 + n), flat(n), round(n), web(n), web((n + 1) % 4)}; Volume(v) = {v}; roller_volumes() += v;
    EndFor
  EndFor
Return

// Levels along z of the outer ring and of the cage: middle (flange or web), row, outer part; mirrored below unless half.
inner_side = row - l / 2 - play; outer_side = row + l / 2 + play;        // faces of the flanges
web_side = row - l / 2 - pocket; rib_side = row + l / 2 + pocket;        // of the cage

// Inner ring.
radii() = {bore, F}; cr() = {nri};
If (half)
  levels() = {0, inner_side, outer_side, B / 2}; cz() = {nh, nz, nf}; rows = 1;
Else
  levels() = {-B / 2, -outer_side, -inner_side, inner_side, outer_side, B / 2}; cz() = {nf, nz, 2 * nh, nz, nf}; rows = 2;
EndIf
ct() = {}; angles() = {}; present() = {};
For i In {0 : Z - 1}
  ct(i) = m;
EndFor
For j In {0 : 2}
  For i In {0 : Z - 1}
    angles(j * Z + i) = -Pi / 2 + (i - 0.5) * sector;
  EndFor
EndFor
For i In {0 : #cz() * Z - 1}
  present(i) = 1;
EndFor
Call Tube;
inner_volumes() = volumes(); inner_raceway() = {}; symmetry() = {};
For k In {0 : nk - 1}
  For i In {0 : Z - 1}
    If (levels(k) == inner_side || levels(k) == -outer_side)
      inner_raceway() += fr((2 * k + 1) * Z + i);
    EndIf
  EndFor
EndFor
For i In {0 : Z - 1}
  bore_faces~{i}() = {};
  For k In {0 : nk - 1}
    bore_faces~{i}() += fr(2 * k * Z + i);
  EndFor
  If (half)
    symmetry() += fz(i);
  EndIf
EndFor

// Outer ring: flanges (radius index 0) and ring (1).
radii() = {O - flange, O, OD}; cr() = {2, nro};
For k In {0 : #cz() - 1}
  For i In {0 : Z - 1}
    in_row = (levels(k) == inner_side || levels(k) == -outer_side);
    present((2 * k) * Z + i) = !in_row; present((2 * k + 1) * Z + i) = 1;
  EndFor
EndFor
Call Tube;
outer_volumes() = volumes(); outer_raceway() = {}; housing() = {}; flange_up() = {}; flange_down() = {};
For k In {0 : nk - 1}
  For i In {0 : Z - 1}
    housing() += fr((3 * k + 2) * Z + i);
    If (levels(k) == inner_side || levels(k) == -outer_side)
      outer_raceway() += fr((3 * k + 1) * Z + i);
      flange_up() += fz(3 * k * Z + i); flange_down() += fz(3 * (k + 1) * Z + i);      // below and above the rollers
    EndIf
    If (half && k == 0)
      symmetry() += {fz(i), fz(Z + i)};
    EndIf
  EndFor
EndFor

// Cage: two cuts a pocket; even blocks are the pockets, odd ones the bars.
radii() = {C1, C2}; cr() = {nc};
If (half)
  levels() = {0, web_side, rib_side, cage / 2}; cz() = {nh, nz, 2};
Else
  levels() = {-cage / 2, -rib_side, -web_side, web_side, rib_side, cage / 2}; cz() = {2, nz, 2 * nh, nz, 2};
EndIf
angles() = {}; ct() = {}; present() = {};
For j In {0 : 1}
  w = Asin((R + pocket) / radii(j));
  For i In {0 : Z - 1}
    angles(2 * j * Z + 2 * i) = -Pi / 2 + i * sector - w; angles(2 * j * Z + 2 * i + 1) = -Pi / 2 + i * sector + w;
    ct(2 * i) = mp; ct(2 * i + 1) = mb;
  EndFor
EndFor
For k In {0 : #cz() - 1}
  For i In {0 : Z - 1}
    in_row = (levels(k) == web_side || levels(k) == -rib_side);
    present(2 * (k * Z + i)) = !in_row; present(2 * (k * Z + i) + 1) = 1;
  EndFor
EndFor
Call Tube;
cage_volumes() = volumes(); pockets() = {};
For k In {0 : nk - 1}
  If (levels(k) == web_side || levels(k) == -rib_side)
    For i In {0 : 2 * Z - 1}
      pockets() += ft(2 * k * 2 * Z + i);
    EndFor
  EndIf
EndFor
If (half)
  For i In {0 : 2 * Z - 1}
    symmetry() += fz(i);
  EndFor
EndIf

// Rollers.
roller_volumes() = {}; side_faces() = {}; lower_ends() = {}; upper_ends() = {};
For r In {1 : rows}
  For i In {0 : Z - 1}
    b = -Pi / 2 + i * sector; z0 = row - l / 2;
    If (r == 2)
      z0 = -row - l / 2;
    EndIf
    Call Roller;
  EndFor
EndFor

Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};

Physical Volume("inner_ring") = {inner_volumes()};
Physical Volume("outer_ring") = {outer_volumes()};
Physical Volume("cage") = {cage_volumes()};
Physical Volume("rollers") = {roller_volumes()};
Physical Surface("inner_raceway") = {inner_raceway()};
Physical Surface("outer_raceway") = {outer_raceway()};
Physical Surface("housing") = {housing()};
Physical Surface("roller_surface") = {side_faces()};
Physical Surface("lower_ends") = {lower_ends()};       // of the rollers, towards -z
Physical Surface("upper_ends") = {upper_ends()};
Physical Surface("lower_flanges") = {flange_up()};      // what the lower ends meet
Physical Surface("upper_flanges") = {flange_down()};
Physical Surface("pockets") = {pockets()};
If (half)
  Physical Surface("symmetry") = {symmetry()};
EndIf
Physical Surface("bore_0") = {bore_faces_0()};
For i In {1 : Floor(Z / 4) + 1}     // sectors of the bore with a part below its middle
  j = Z - i;
  Physical Surface(Sprintf("bore_%g", i)) = {bore_faces~{i}(), bore_faces~{j}()};
EndFor
