// Yielding joint of a steel arch: two nested channel profiles with ears (like TH29, straight) held together by two clamps, each a bar over
// the upper ears and two C-shaped yokes that pull the bar against the lower ears. Sections are meshed with quadrangles and swept along z.
DefineConstant[ h = 5 ];                            // cell size
DefineConstant[ L = 300, overlap = 200, clamp = 40 ]; // length of a profile, of the overlap, of a clamp along z
DefineConstant[ order = 1 ];   // 2: cells of second order
Mesh.ElementOrder = order;
Mesh.Algorithm = 6;
Geometry.OldNewReg = 0;
rise = 29;                                          // the upper profile stands so much higher: ear on ear

// A closed polygon xs(), ys() (counter-clockwise) at height z0, swept over `length` in `layers`; `volume`, and faces() of its edges.
Macro Sweep
  p() = {}; l() = {};
  For i In {0 : #xs() - 1}
    p(i) = newp; Point(p(i)) = {xs(i), ys(i), z0, h};
  EndFor
  For i In {0 : #xs() - 1}
    l(i) = newl; Line(l(i)) = {p(i), p((i + 1) % #xs())};
  EndFor
  loop = newll; Curve Loop(loop) = {l()};
  s = news; Plane Surface(s) = {loop};
  Recombine Surface {s};
  e() = Extrude {0, 0, length} { Surface{s}; Layers{Ceil(length / h)}; Recombine; };
  near = s; far = e(0); volume = e(1);
  faces() = {};
  For i In {0 : #xs() - 1}
    faces(i) = e(2 + i);
  EndFor
Return

// Corners of the profile: web, flank, ear, and back inside. Edges: 3 ear bottom (right), 5 ear top (right), 9 ear top (left), 11 ear bottom (left).
px() = {-18.5, 18.5, 60.8, 75.25, 75.25, 62.1, 14.47, -14.47, -62.1, -75.25, -75.25, -60.8};
py() = {0, 0, 95, 95, 124, 124, 17, 17, 124, 124, 95, 95};

xs() = px(); ys() = py(); z0 = 0; length = L; Call Sweep;
Physical Volume("lower") = {volume};
Physical Surface("fixed") = {near};
Physical Surface("lower_ear_bottom") = {faces(2), faces(10)};
Physical Surface("lower_ear_top") = {faces(4), faces(8)};

xs() = px(); ys() = py(); z0 = L - overlap; length = L;
For i In {0 : #ys() - 1}
  ys(i) += rise;
EndFor
Call Sweep;
Physical Volume("upper") = {volume};
Physical Surface("pulled") = {far};
Physical Surface("upper_ear_bottom") = {faces(2), faces(10)};
Physical Surface("upper_ear_top") = {faces(4), faces(8)};

For k In {0 : 1}
  z0 = L - overlap + 0.25 * overlap + k * 0.5 * overlap - clamp / 2; length = clamp;
  xs() = {-88, 88, 88, -88}; ys() = {124 + rise, 124 + rise, 154 + rise, 154 + rise};
  Call Sweep;
  bars() += volume; bar_bottom() += faces(0); bar_top() += faces(2);
  xs() = {63, 112, 112, 64, 64, 90, 90, 63}; ys() = {65, 65, 184 + rise, 184 + rise, 154 + rise, 154 + rise, 95, 95};
  Call Sweep;
  yokes() += volume; yoke_arm() += faces(4); yoke_shelf() += faces(6);
  xs() = {-63, -63, -90, -90, -64, -64, -112, -112}; ys() = {65, 95, 95, 154 + rise, 154 + rise, 184 + rise, 184 + rise, 65};
  Call Sweep;
  yokes() += volume; yoke_arm() += faces(3); yoke_shelf() += faces(1);
EndFor
Physical Volume("bars") = {bars()};
Physical Volume("yokes") = {yokes()};
Physical Surface("bar_bottom") = {bar_bottom()};
Physical Surface("bar_top") = {bar_top()};
Physical Surface("yoke_arm") = {yoke_arm()};
Physical Surface("yoke_shelf") = {yoke_shelf()};
