# Decks that must fail, and how: those that fail while several ranks work, on two of them, since all must end together.
foreach(deck no_equilibrium_slide mechanism wrong_keys)
  mortise_regression(${deck} DIRECTORY must_fail RANKS 1 2)
endforeach()
foreach(deck no_equilibrium_lift ring_off_cone not_converged takes_turns steps_no_equilibrium untouched_loaded idle_preload contradicting_normals cyclic_free
        held_in_obstacle held_overlap clamped_borders far_away not_positive_definite open_surface large_surface crossing_border interior_lost
        held_coupling turning_coupling formula_at_zero lost_points lost_probes torn_coupling torn_bond torn_formulas
        torn_sector lost_temperatures slipping_ring load_beyond_edge leaves_the_wall)
  mortise_regression(${deck} DIRECTORY must_fail RANKS 2 STUDY_RANKS 1)
endforeach()
# What is known once the deck and the mesh are read, or is lost as points are.
foreach(deck no_file contradiction lost_grain two_orders two_orders_of_lines wrong_orthotropy lost_points_by_name lost_curves lost_springs)
  mortise_regression(${deck} DIRECTORY must_fail RANKS 1 STUDY_RANKS 2)
endforeach()
foreach(deck wrong_fits beyond_axis wrong_formulation wrong_auto wrong_names wrong_instances wrong_patterns wrong_preloads
        wrong_temperatures wrong_loads wrong_obstacles preload_without_seat wrong_cyclic cyclic_wrong_way too_many_cells
        script_in_disguise script_with_commands hostile_aliases hostile_alias_within hostile_numbers too_many_copies wrong_surfaces
        wrong_couplings wrong_formulas polar_rings wrong_axes moved_axis wrong_probes wrong_springs no_constant own_constant tab
        wrong_body_patterns copies_of_pattern uncovered_body across_sectors two_entries moved_into_obstacle)
  mortise_regression(${deck} DIRECTORY must_fail RANKS 1)
endforeach()
mortise_regression(across_sectors VARIANT .oblique DIRECTORY must_fail RANKS 1
                   SET "contacts[0].cyclic.axis=[1,1,1]" "couplings.hub.point=[1,1,1]" EXPECTED must_fail/across_sectors.oblique.expected.json)
mortise_regression(cyclic_wrong_way VARIANT .touching DIRECTORY must_fail RANKS 1 STUDY_RANKS 2 SET "contacts[0].friction={tresca: 1}"
                   EXPECTED must_fail/cyclic_wrong_way.touching.expected.json)
# Beyond friction, whichever side carries the multipliers: facets that do not match are no support. Below it a torque goes through.
mortise_regression(slipping_ring VARIANT .other_side DIRECTORY must_fail RANKS 1 STUDY_RANKS 2 SET "contacts[0].secondary=seat" "contacts[0].primary=hole")
mortise_regression(slipping_ring VARIANT .other_side_tresca DIRECTORY must_fail RANKS 1 STUDY_RANKS 3
                   SET "contacts[0].secondary=seat" "contacts[0].primary=hole" "contacts[0].friction={tresca: 0.3222}")
mortise_regression(ring_passes_torque RANKS 1 STUDY_RANKS 2)
mortise_regression(ring_passes_torque VARIANT .other_side RANKS 1 SET "contacts[0].secondary=seat" "contacts[0].primary=hole")
mortise_regression(ring_passes_torque VARIANT .bonded RANKS 1 SET "contacts[0]={name: fit, secondary: hole, primary: seat, friction: {bonded: true}}")
# Motions that nothing but facets of the mesh resists, whichever side carries the multipliers.
mortise_regression(pulled_plate DIRECTORY must_fail RANKS 1 2 3)
foreach(deck turned_plate ball_in_cup bar_in_vee)
  mortise_regression(${deck} DIRECTORY must_fail RANKS 2 STUDY_RANKS 1 3)
endforeach()
foreach(deck pulled_plate turned_plate ball_in_cup bar_in_vee)
  mortise_regression(${deck} VARIANT .second_order DIRECTORY must_fail RANKS 1 SET mesh.constants.order=2)
endforeach()
# A twentieth less than statics asks of friction.
mortise_regression(slipping_ladder DIRECTORY must_fail RANKS 1 STUDY_RANKS 2)
mortise_regression(pushed_in_groove DIRECTORY must_fail RANKS 1)
# A little more than friction holds, with bodies that slide on and a plug that leaves its seat.
foreach(deck slipping_clutch pulled_plug)
  mortise_regression(${deck} DIRECTORY must_fail RANKS 1 STUDY_RANKS 2)
endforeach()
mortise_regression(shaft_in_vee DIRECTORY must_fail RANKS 1 STUDY_RANKS 2 3)
mortise_regression(shaft_in_vee VARIANT .first_order DIRECTORY must_fail RANKS 1 SET mesh.order=1 mesh.constants.n=36)
mortise_regression(shaft_in_vee VARIANT .holds DIRECTORY must_fail RANKS 1 EXPECTED must_fail/shaft_in_vee.holds.expected.json
                   SET "loads[1].moment=[0, 0, 269.2]")
# Pressed straight down it stays, and coarse facets push it aside, which is told.
mortise_regression(ball_in_cup VARIANT .coarse DIRECTORY must_fail RANKS 1 STUDY_RANKS 2 EXPECTED must_fail/ball_in_cup.coarse.expected.json
                   SET "loads=[{boundary: handle, force: [0, 0, -1000]}]" mesh.constants.size=4 solver.tolerance=1e-6)
# With twice what friction holds: the ball turns until tilts of rounding wedge it.
set(pushed "loads[0].force=[260, 0, -1000]" "contacts[0].friction={coulomb: 0.2}")
mortise_regression(ball_in_cup VARIANT .friction DIRECTORY must_fail RANKS 2 STUDY_RANKS 1 SET ${pushed})
mortise_regression(ball_in_cup VARIANT .friction_second_order DIRECTORY must_fail RANKS 1 SET ${pushed} mesh.constants.order=2)
mortise_regression(ball_in_cup VARIANT .friction_other_side DIRECTORY must_fail RANKS 1
                   SET ${pushed} mesh.constants.order=2 "contacts=[{secondary: 'cup:round', primary: 'ball:round', friction: {coulomb: 0.2}}]")
# The same of supports along normals, prescribed or on springs.
mortise_regression(guided_pile DIRECTORY must_fail RANKS 1 STUDY_RANKS 2)
mortise_regression(guided_pile VARIANT .second_order DIRECTORY must_fail RANKS 1 SET mesh.constants.order=2)
mortise_regression(guided_pile VARIANT .springs DIRECTORY must_fail RANKS 1 SET "supports[0]={boundary: skin, stiffness: {normal: 30}}")
mortise_regression(pulled_plate VARIANT .little DIRECTORY must_fail RANKS 1 SET "loads=[{boundary: end, force: [1000, 0, 0.5]}]")
mortise_regression(pulled_plate VARIANT .later DIRECTORY must_fail RANKS 2 STUDY_RANKS 1 EXPECTED must_fail/pulled_plate.later.expected.json
                   SET "loads=[{name: across, boundary: end, force: [1000, 0, 0]}, {name: along, boundary: end, force: [0, 0, 0.5]}]"
                       "steps=[{scale: {along: 0}}, {scale: {along: 1}}]")
mortise_regression(pulled_plate VARIANT .no_clearance DIRECTORY must_fail RANKS 1 SET mesh.constants.clearance=0)
# A load on a curved face turns the plate a little by its facets; along the pin another one is exact all the same.
mortise_regression(squeezed_on_pin VARIANT .pulled RANKS 1 STUDY_RANKS 2 EXPECTED must_fail/pulled_plate.expected.json
                   SET "loads=[{boundary: rim, force: [1000, 0, 0]}, {boundary: high, force: [0, 0, 0.2]}]")
# So little of it is left out of the solution, which is told.
mortise_regression(squeezed_on_pin VARIANT .little RANKS 1 EXPECTED cases/squeezed_on_pin.little.expected.json
                   SET "loads=[{boundary: rim, force: [1000, 0, 0]}, {boundary: high, force: [0, 0, 0.02]}]")
mortise_regression(pulled_plate VARIANT .other_side DIRECTORY must_fail RANKS 1 SET "contacts=[{secondary: shaft, primary: hole}]")
mortise_regression(out_of_memory DIRECTORY must_fail RANKS 1)
foreach(deck no_equilibrium_slide no_equilibrium_lift)
  mortise_regression(${deck} VARIANT .smalse DIRECTORY must_fail RANKS 1 SET solver.algorithm=smalse)
endforeach()

foreach(deck no_equilibrium_slide mechanism)
  mortise_regression(${deck} VARIANT .clusters DIRECTORY must_fail RANKS 2 STUDY_RANKS 1
                     SET "decomposition={unknowns_per_subdomain: 100, subdomains_per_cluster: 8}")
endforeach()
