// Yielding joint of a steel arch support: two nested channel profiles with ears, like TH29 but straight, held together by clamps, each a bar over the upper ears, a
// U-shaped yoke under the lower ears and two bolts. All hexahedra, swept. A bolt is two bodies that meet at a cut through its shank, for the preload. Axis z; mm.
DefineConstant[ size = 1 ];                          // cells a unit: 1 for a laptop, 2 the paper's size
DefineConstant[ clamps = 2 ];
DefineConstant[ L = 700, overlap = 400 ];            // lengths of a profile and of the overlap
DefineConstant[ width = 60, thick = 30 ];            // of bar and yoke, along z and y
DefineConstant[ bolt = 97, shank = 12, hole = 13, head = 18, head_height = 15 ]; // |x| of the bolts; radii; height of heads and nuts
DefineConstant[ gap = 3 ];                           // between yoke and lower profile
DefineConstant[ order = 1 ];                         // 2: cells of second order
Mesh.ElementOrder = order; Geometry.OldNewReg = 0; Geometry.AutoCoherence = 0;
rise = 29; bend = 95; top = 124;                     // the upper profile stands so much higher, ear on ear; heights of an ear's bottom and top

// A plane section, points (u(), v()) and quadrangles of 4 points each in corners(), counter-clockwise, cut() cells along their first and second edge, swept through
// w() in layers(). centre(a * n + b), if not 0: the edge from point a to b is an arc round that point.
// present(k * quadrangles + q): is there a volume over quadrangle q in layer k (empty: everywhere). upright = 0: (u, v, w) is (x, y, z), 1: (x, -z, y).
// Fills volumes(), faces(k * quadrangles + q) at level k, and walls(k * n * n + a * n + b) over the edge a-b in layer k.
Macro Sweep
  n = #u(); nq = #corners() / 4; nw = #layers(); P() = {}; E() = {}; W() = {}; faces() = {}; walls() = {}; volumes() = {};
  For k In {0 : n * n * (nw + 1) - 1}
    E(k) = 0; walls(k) = 0;
  EndFor
  For k In {0 : nw}
    For i In {0 : n - 1}
      q = newp;
      If (upright)
        Point(q) = {u(i), w(k), -v(i)};
      Else
        Point(q) = {u(i), v(i), w(k)};
      EndIf
      P(k * n + i) = q;
      If (k < nw)
        W(k * n + i) = 0;
      EndIf
    EndFor
  EndFor
  For k In {0 : nw - 1}
    For i In {0 : n - 1}
      c = newl; Line(c) = {P(k * n + i), P((k + 1) * n + i)}; Transfinite Curve {c} = layers(k) + 1; W(k * n + i) = c;
    EndFor
  EndFor
  For k In {0 : nw}
    For q In {0 : nq - 1}
      For e In {0 : 3}
        a = corners(4 * q + e); b = corners(4 * q + (e + 1) % 4);
        If (E(k * n * n + a * n + b) == 0)
          c = newl; o = centre(a * n + b);
          If (o > 0)
            Circle(c) = {P(k * n + a), P(k * n + o), P(k * n + b)};
          Else
            Line(c) = {P(k * n + a), P(k * n + b)};
          EndIf
          Transfinite Curve {c} = cut(2 * q + e % 2) + 1;
          E(k * n * n + a * n + b) = c; E(k * n * n + b * n + a) = -c;
          If (k < nw)
            walls(k * n * n + a * n + b) = -1; walls(k * n * n + b * n + a) = -1;
          EndIf
        EndIf
      EndFor
      a = corners(4 * q); b = corners(4 * q + 1); c = corners(4 * q + 2); d = corners(4 * q + 3); m = k * n * n;
      f = newll; Curve Loop(f) = {E(m + a * n + b), E(m + b * n + c), E(m + c * n + d), E(m + d * n + a)}; Plane Surface(f) = {f};
      faces(k * nq + q) = f;
    EndFor
  EndFor
  For k In {0 : nw - 1}
    For a In {0 : n - 1}
      For b In {a + 1 : n - 1}
        m = k * n * n;
        If (walls(m + a * n + b) == -1)
          f = newll; Curve Loop(f) = {E(m + a * n + b), W(k * n + b), -E(m + n * n + a * n + b), -W(k * n + a)};
          If (centre(a * n + b) > 0 || centre(b * n + a) > 0)
            Surface(f) = {f};
          Else
            Plane Surface(f) = {f};
          EndIf
          walls(m + a * n + b) = f; walls(m + b * n + a) = f;
        EndIf
      EndFor
    EndFor
    For q In {0 : nq - 1}
      a = corners(4 * q); b = corners(4 * q + 1); c = corners(4 * q + 2); d = corners(4 * q + 3); m = k * n * n;
      here = 1;
      If (#present() > 0)
        here = present(k * nq + q);
      EndIf
      If (here)
        s = newv; Surface Loop(s) = {faces(k * nq + q), faces((k + 1) * nq + q), walls(m + a * n + b), walls(m + b * n + c), walls(m + c * n + d), walls(m + d * n + a)};
        Volume(s) = {s}; volumes() += s;
      EndIf
    EndFor
  EndFor
Return

// found(): the faces over the edges of the section swept last, edges() holding their points in pairs. (What follows a Call on its line is not read.)
Macro Over
  found() = {};
  For e In {0 : #edges() / 2 - 1}
    For k In {0 : nw - 1}
      found() += walls(k * n * n + edges(2 * e) * n + edges(2 * e + 1));
    EndFor
  EndFor
Return

Macro NoArcs
  centre() = {};
  For k In {0 : #u() * #u() - 1}
    centre(k) = 0;
  EndFor
Return

present() = {};

// A plate with a bolt's hole at (bolt, 0), x from x1 to x2, and strips beyond it along z; points 0-3 of the hole, 4-7 round it, 8-11 the plate's corners.
x1 = 78; x2 = 122; half = 18;
hu() = {}; hv() = {};
For i In {0 : 3}
  hu(i) = bolt + hole * Cos(-0.75 * Pi + i * Pi / 2); hv(i) = hole * Sin(-0.75 * Pi + i * Pi / 2);
EndFor
hu() += {x1, x2, x2, x1, x1, x2, x2, x1, bolt}; hv() += {-half, -half, half, half, -width / 2, -width / 2, width / 2, width / 2, 0};
plate() = {4, 5, 1, 0,   5, 6, 2, 1,   6, 7, 3, 2,   7, 4, 0, 3,   8, 9, 5, 4,   7, 6, 10, 11};
around = 6 * size; radial = 2 * size; strip = 2 * size;
plate_cut() = {around, radial, around, radial, around, radial, around, radial, around, strip, around, strip};

// Both plates of a bar or a yoke: points 0-12 and, mirrored, 13-25; the quadrangles of the first, those of the second with their first edges first again.
Macro Plates
  u() = {}; v() = {}; corners() = {}; cut() = {}; upright = 1; n = 26;
  For i In {0 : 12}
    u(i) = hu(i); v(i) = hv(i) - zc;
  EndFor
  For i In {0 : 12}
    u(13 + i) = -hu(i); v(13 + i) = hv(i) - zc;
  EndFor
  Call NoArcs;
  For i In {0 : 3}
    a = i; b = (i + 1) % 4;
    centre(a * n + b) = 12; centre(b * n + a) = 12; centre((13 + a) * n + 13 + b) = 25; centre((13 + b) * n + 13 + a) = 25;
  EndFor
  corners() = plate();
  For q In {0 : 5}
    For e In {0 : 3}
      corners() += 13 + plate(4 * q + (5 - e) % 4);
    EndFor
  EndFor
  cut() = {plate_cut(), plate_cut()};
Return

bar_volumes() = {}; bar_bottom() = {}; bar_top() = {}; yoke_volumes() = {}; yoke_shelf() = {}; yoke_bottom() = {};
upper_bolts() = {}; lower_bolts() = {}; head_bottom() = {}; nut_top() = {}; cut_above() = {}; cut_below() = {};

// Yokes: shelves with holes, and the U between them swept along z through the same three strips. They are drawn first, since Coherence joins all that coincides.
For clamp In {1 : clamps}
  zc = L - overlap + overlap * (clamp - 0.5) / clamps;
  Call Plates;
  w() = {bend - thick, bend}; layers() = {4 * size}; Call Sweep;
  yoke_volumes() += volumes(); yoke_shelf() += faces({nq : 2 * nq - 1}); yoke_bottom() += {faces({0 : 3}), faces({6 : 9})};

  inside = 60.8 + 1.1 * gap; under = inside - thick * (60.8 - 18.5) / bend; foot = 18.5 + 0.8 * gap;
  u() = {x1, x1, inside, under, foot, 43, -x1, -x1, -inside, -under, -foot, -43};
  v() = {bend - thick, bend, bend, bend - thick, -gap, -gap - 20, bend - thick, bend, bend, bend - thick, -gap, -gap - 20};
  corners() = {3, 0, 1, 2,   4, 5, 0, 3,   11, 5, 4, 10,   6, 9, 8, 7,   11, 10, 9, 6};
  cut() = {3 * size, 4 * size,   3 * size, 9 * size,   8 * size, 3 * size,   3 * size, 4 * size,   3 * size, 9 * size};
  upright = 0;
  Call NoArcs;
  w() = {zc - width / 2, zc - half, zc + half, zc + width / 2}; layers() = {strip, around, strip}; Call Sweep;
  yoke_volumes() += volumes();
  edges() = {1, 2, 7, 8};
  Call Over;
  yoke_shelf() += found();
EndFor
Coherence;

// Bars: the plates and what is between them. Bolts: section of the shank (a square core and four sides) and round it a ring for head and nut.
For clamp In {1 : clamps}
  zc = L - overlap + overlap * (clamp - 0.5) / clamps;
  Call Plates;
  corners() += {21, 8, 4, 17,   17, 4, 7, 20,   20, 7, 11, 24}; cut() += {16 * size, strip, 16 * size, around, 16 * size, strip};
  w() = {top + rise, top + rise + thick}; layers() = {4 * size}; Call Sweep;
  bar_volumes() += volumes(); bar_bottom() += faces({0 : nq - 1}); bar_top() += {faces({nq : nq + 3}), faces({nq + 6 : nq + 9})};

  For side In {-1 : 1 : 2}
    xb = side * bolt; u() = {}; v() = {}; upright = 1;
    radius() = {0.5 * shank, shank, head};
    For j In {0 : 2}
      For i In {0 : 3}
        phi = -0.75 * Pi + i * Pi / 2; u(4 * j + i) = xb + radius(j) * Cos(phi); v(4 * j + i) = radius(j) * Sin(phi) - zc;
      EndFor
    EndFor
    u(12) = xb; v(12) = -zc; n = 13; Call NoArcs;
    For j In {1 : 2}
      For i In {0 : 3}
        a = 4 * j + i; b = 4 * j + (i + 1) % 4; centre(a * n + b) = 12; centre(b * n + a) = 12;
      EndFor
    EndFor
    corners() = {0, 1, 2, 3,   4, 5, 1, 0,   5, 6, 2, 1,   6, 7, 3, 2,   7, 4, 0, 3,   8, 9, 5, 4,   9, 10, 6, 5,   10, 11, 7, 6,   11, 8, 4, 7};
    q = 4 * size; r = 2 * size; cut() = {q, q, q, r, q, r, q, r, q, r, q, r, q, r, q, r, q, r};
    halfway = 0.5 * (bend - thick + top + rise + thick);
    w() = {halfway, top + rise + thick, top + rise + thick + head_height}; layers() = {8 * size, 2 * size};
    present() = {1, 1, 1, 1, 1, 0, 0, 0, 0,   1, 1, 1, 1, 1, 1, 1, 1, 1}; Call Sweep;
    upper_bolts() += volumes(); cut_above() += faces({0 : 4}); head_bottom() += faces({14 : 17});
    w() = {bend - thick - head_height, bend - thick, halfway}; layers() = {2 * size, 8 * size};
    present() = {1, 1, 1, 1, 1, 1, 1, 1, 1,   1, 1, 1, 1, 1, 0, 0, 0, 0}; Call Sweep;
    lower_bolts() += volumes(); cut_below() += faces({18 : 22}); nut_top() += faces({14 : 17});
    present() = {};
  EndFor
EndFor

// Profile. Points outside: web, flank, ear; inside; the right half first.
slope = (top - 17) / (62.1 - 14.47);                 // of the inner line
inner_x = 14.47 + (bend - 17) / slope;
middle = 67.5;                                       // divides the ear
px() = {18.5, 14.47, 60.8, inner_x, 75.25, middle, 62.1, 75.25, -18.5, -14.47, -60.8, -inner_x, -75.25, -middle, -62.1, -75.25};
py() = {0, 17, bend, bend, bend, top, top, top, 0, 17, bend, bend, bend, top, top, top};
profile() = {8, 0, 1, 9,   0, 2, 3, 1,   3, 2, 5, 6,   2, 4, 7, 5,   8, 9, 11, 10,   11, 14, 13, 10,   10, 13, 15, 12};
t = 2 * size;                                        // cells through the thickness
profile_cut() = {5 * size, t,   15 * size, t,   t, 4 * size,   3 * size, 4 * size,   t, 15 * size,   4 * size, t,   4 * size, 3 * size};

u() = px(); v() = py(); corners() = profile(); cut() = profile_cut(); Call NoArcs;
w() = {0, L}; layers() = {Ceil(L / 8) * size}; upright = 0; Call Sweep;
Physical Volume("lower") = {volumes()};
Physical Surface("fixed") = {faces({0 : nq - 1})};
edges() = {2, 4, 10, 12};
Call Over;
Physical Surface("lower_ear_bottom") = {found()};
edges() = {6, 5, 5, 7, 14, 13, 13, 15};
Call Over;
Physical Surface("lower_ear_top") = {found()};

For i In {0 : #v() - 1}
  v(i) += rise;
EndFor
w() = {L - overlap, 2 * L - overlap}; Call Sweep;
Physical Volume("upper") = {volumes()};
Physical Surface("pulled") = {faces({nq : 2 * nq - 1})};
edges() = {2, 4, 10, 12};
Call Over;
Physical Surface("upper_ear_bottom") = {found()};
edges() = {6, 5, 5, 7, 14, 13, 13, 15};
Call Over;
Physical Surface("upper_ear_top") = {found()};

Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};

Physical Volume("bars") = {bar_volumes()};
Physical Volume("yokes") = {yoke_volumes()};
Physical Volume("upper_bolts") = {upper_bolts()};       // head and half a shank
Physical Volume("lower_bolts") = {lower_bolts()};       // nut and half a shank
Physical Surface("bar_bottom") = {bar_bottom()};
Physical Surface("bar_top") = {bar_top()};              // round the holes
Physical Surface("yoke_shelf") = {yoke_shelf()};
Physical Surface("yoke_bottom") = {yoke_bottom()};      // round the holes
Physical Surface("head_bottom") = {head_bottom()};
Physical Surface("nut_top") = {nut_top()};
Physical Surface("cut_above") = {cut_above()};          // of the upper half of a bolt
Physical Surface("cut_below") = {cut_below()};
