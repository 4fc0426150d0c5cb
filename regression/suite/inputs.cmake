# The inputs, against formulas where there are some.
mortise_regression(press_fit DIRECTORY ../inputs/press_fit EXPECTED inputs/press_fit.expected.json RANKS 2)
foreach(deck hertz_sphere hertz_cylinder cantilever_2d)
  mortise_regression(${deck} DIRECTORY ../inputs/${deck} EXPECTED inputs/${deck}.expected.json RANKS 1 STUDY_RANKS 2)
endforeach()
foreach(deck press_fit hertz_cylinder cantilever_2d)
  mortise_regression(${deck} VARIANT .smalse DIRECTORY ../inputs/${deck} EXPECTED inputs/${deck}.expected.json RANKS 1 STUDY_RANKS 2
                     SET solver.algorithm=smalse)
endforeach()
foreach(deck hertz_sphere roller_bearing)
  mortise_regression(${deck} VARIANT .smalse DIRECTORY ../inputs/${deck} EXPECTED inputs/${deck}.expected.json STUDY_RANKS 2
                     SET solver.algorithm=smalse)
endforeach()
# The bearings as they stand; in the suite the first with half as many layers along its axis, on which its forces and its energy do not depend.
foreach(deck roller_bearing bearing_boundary)
  mortise_regression(${deck} DIRECTORY ../inputs/${deck} EXPECTED inputs/${deck}.expected.json STUDY_RANKS 2)
endforeach()
mortise_regression(roller_bearing VARIANT .layers DIRECTORY ../inputs/roller_bearing EXPECTED inputs/roller_bearing.expected.json RANKS 2
                   SET mesh.constants.nz=3)
# As coarse as it can be. Forces of the bolts also by Tresca problems, each solved by itself, within 3e-5; products may vary with the ranks.
mortise_regression(yielding_clamp DIRECTORY ../inputs/yielding_clamp EXPECTED inputs/yielding_clamp.expected.json RANKS 1 STUDY_RANKS 2
                   SET mesh.constants.size=0.6 decomposition.unknowns_per_subdomain=250)
mortise_regression(fan_wheel DIRECTORY ../inputs/fan_wheel EXPECTED inputs/fan_wheel.expected.json RANKS 1 STUDY_RANKS 2)
# As coarse as it can be: forces and moments by statics.
mortise_regression(bolted_bracket DIRECTORY ../inputs/bolted_bracket EXPECTED inputs/bolted_bracket.expected.json RANKS 1 STUDY_RANKS 2
                   SET mesh.size.max=14 mesh.size.min=5 mesh.size.curvature=8)
# Bodies of revolution.
mortise_regression(press_fit_axisymmetric DIRECTORY ../inputs/press_fit EXPECTED inputs/press_fit_axisymmetric.expected.json RANKS 1 STUDY_RANKS 2)
mortise_regression(press_fit_axisymmetric VARIANT .smalse DIRECTORY ../inputs/press_fit EXPECTED inputs/press_fit_axisymmetric.expected.json
                   STUDY_RANKS 2 SET solver.algorithm=smalse)
mortise_regression(hertz_sphere_axisymmetric DIRECTORY ../inputs/hertz_sphere EXPECTED inputs/hertz_sphere_axisymmetric.expected.json
                   RANKS 1 STUDY_RANKS 2)
mortise_regression(hertz_sphere_axisymmetric VARIANT .smalse DIRECTORY ../inputs/hertz_sphere
                   EXPECTED inputs/hertz_sphere_axisymmetric.expected.json STUDY_RANKS 2 SET solver.algorithm=smalse solver.tolerance=1e-9)
# Stopped where the solver's error is a tenth of the mesh's.
mortise_regression(hertz_cylinder VARIANT .auto DIRECTORY ../inputs/hertz_cylinder EXPECTED inputs/hertz_cylinder_auto.expected.json
                   RANKS 1 STUDY_RANKS 2 SET solver.tolerance=auto)
# Fine faces beside which the gap is wide: the edge of contact, 6.21, and no peak beside it.
mortise_regression(hertz_cylinder VARIANT .fine DIRECTORY ../inputs/hertz_cylinder EXPECTED inputs/hertz_cylinder_fine.expected.json
                   RANKS 1 STUDY_RANKS 2 SET mesh.constants.h=0.05)
# Cells of second order on coarser meshes.
mortise_regression(press_fit VARIANT .second_order DIRECTORY ../inputs/press_fit EXPECTED inputs/press_fit_second_order.expected.json
                   RANKS 1 STUDY_RANKS 2 SET mesh.constants.order=2 mesh.constants.n=8)
mortise_regression(hertz_cylinder VARIANT .second_order DIRECTORY ../inputs/hertz_cylinder
                   EXPECTED inputs/hertz_cylinder_second_order.expected.json RANKS 1 STUDY_RANKS 2 SET mesh.constants.order=2 mesh.constants.h=0.8)
mortise_regression(hertz_sphere VARIANT .second_order DIRECTORY ../inputs/hertz_sphere
                   EXPECTED inputs/hertz_sphere_second_order.expected.json RANKS 1 STUDY_RANKS 2 SET mesh.constants.order=2 mesh.constants.h=0.2)
mortise_regression(cattaneo_mindlin DIRECTORY ../inputs/hertz_cylinder EXPECTED inputs/cattaneo_mindlin.expected.json RANKS 1)
mortise_regression(cattaneo_mindlin VARIANT .smalse DIRECTORY ../inputs/hertz_cylinder EXPECTED inputs/cattaneo_mindlin.expected.json RANKS 1
                   SET solver.algorithm=smalse)
# The bearing without its named contacts: the most loaded roller carries 4.00 F / Z.
mortise_regression(roller_bearing VARIANT .auto DIRECTORY ../inputs/roller_bearing EXPECTED inputs/roller_bearing_auto.expected.json
                   STUDY_RANKS 2 SET contacts=auto solver.tolerance=1e-6)
