# Fits without a load, on every cell; from both sides under the label study.
add_test(NAME regression.fits COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fits/fits.py $<TARGET_FILE:mortise>
         --mpiexec ${MPIEXEC_EXECUTABLE} --quick)
set_tests_properties(regression.fits PROPERTIES COST 40 LABELS regression TIMEOUT 900)  # most of its runs have one rank
add_test(NAME regression.fits.study COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fits/fits.py $<TARGET_FILE:mortise>
         --mpiexec ${MPIEXEC_EXECUTABLE})
set_tests_properties(regression.fits.study PROPERTIES LABELS study TIMEOUT 900)
add_test(NAME regression.kinks COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fits/kinks.py $<TARGET_FILE:mortise>)
add_test(NAME regression.flats COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fits/flats.py $<TARGET_FILE:mortise>)
add_test(NAME regression.lobes COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fits/lobes.py $<TARGET_FILE:mortise>)
set_tests_properties(regression.kinks regression.flats regression.lobes PROPERTIES COST 30 LABELS regression TIMEOUT 900)
mortise_regression(fit_steps RANKS 1 STUDY_RANKS 3)

# The paper's algorithm must find the same, and so must the other preconditioners.
mortise_regression(coulomb_block VARIANT .smalse RANKS 1 2 3 SET solver.algorithm=smalse)
foreach(deck cantilevers_tresca stack no_contact)
  mortise_regression(${deck} VARIANT .smalse RANKS 2 SET solver.algorithm=smalse)
endforeach()
foreach(deck patch_hex patch_axisymmetric patch_plane_strain patch_hex20_tet10 rubber_block bonded_metis gap roller)
  mortise_regression(${deck} VARIANT .smalse RANKS 1 STUDY_RANKS 2 SET solver.algorithm=smalse)
endforeach()
# The algorithm sees no cells: one patch test a kind of problem is enough for the suite.
foreach(deck patch_tet_prism patch_prism_hex patch_plane_stress patch_quad8_tri6 patch_tet10_hex8 patch_prism15_hex27)
  mortise_regression(${deck} VARIANT .smalse STUDY_RANKS 2 SET solver.algorithm=smalse)
endforeach()
mortise_regression(held_plate VARIANT .smalse RANKS 1 STUDY_RANKS 2 SET solver.algorithm=smalse solver.tolerance=1e-8)
mortise_regression(rigid_wall VARIANT .smalse EXPECTED cases/rigid_wall_smalse.expected.json RANKS 2 SET solver.algorithm=smalse)
foreach(deck steps_hysteresis steps_switch)
  mortise_regression(${deck} VARIANT .smalse RANKS 1 STUDY_RANKS 2 SET solver.algorithm=smalse)
endforeach()
mortise_regression(cantilevers_tresca VARIANT .dirichlet RANKS 2 SET solver.preconditioner=dirichlet)
foreach(deck coulomb_block roller)
  mortise_regression(${deck} VARIANT .dirichlet RANKS 1 STUDY_RANKS 2 SET solver.preconditioner=dirichlet)
endforeach()
mortise_regression(cantilevers_tresca VARIANT .unpreconditioned RANKS 1 STUDY_RANKS 2 SET solver.preconditioner=none)

# Hybrid TFETI: the same from clusters of subdomains, whichever the ranks.
foreach(deck bonded_metis instances_blocks)
  mortise_regression(${deck} VARIANT .clusters RANKS 1 2 3 SET decomposition.subdomains_per_cluster=8)
endforeach()
mortise_regression(thermal_bar VARIANT .clusters RANKS 2 STUDY_RANKS 1 3 SET decomposition.subdomains_per_cluster=8)
mortise_regression(coulomb_block VARIANT .clusters RANKS 1 2 3 SET "decomposition={unknowns_per_subdomain: 60, subdomains_per_cluster: 8}")
mortise_regression(steps_hysteresis VARIANT .clusters RANKS 1 STUDY_RANKS 3 SET "decomposition={unknowns_per_subdomain: 100, subdomains_per_cluster: 8}")
mortise_regression(preload_two_bolts VARIANT .clusters RANKS 1 STUDY_RANKS 3 SET "decomposition={unknowns_per_subdomain: 30, subdomains_per_cluster: 4}")
mortise_regression(roller VARIANT .clusters RANKS 2 STUDY_RANKS 1 SET "decomposition={unknowns_per_subdomain: 150, subdomains_per_cluster: 8}")
mortise_regression(patch_plane_strain VARIANT .clusters RANKS 2 SET "decomposition={unknowns_per_subdomain: 12, subdomains_per_cluster: 4}")
mortise_regression(patch_axisymmetric VARIANT .clusters RANKS 1 STUDY_RANKS 2 SET "decomposition={unknowns_per_subdomain: 20, subdomains_per_cluster: 8}")
mortise_regression(stack VARIANT .clusters_smalse RANKS 2 SET solver.algorithm=smalse decomposition.subdomains_per_cluster=8)
mortise_regression(roller VARIANT .clusters_dirichlet RANKS 1 STUDY_RANKS 2 SET solver.preconditioner=dirichlet
                   "decomposition={unknowns_per_subdomain: 150, subdomains_per_cluster: 8}")

foreach(formulation bbar incompatible)
  mortise_regression(patch_hex VARIANT .${formulation} RANKS 1 STUDY_RANKS 2
                     SET bodies.lower.formulation=${formulation} bodies.upper.formulation=${formulation})
endforeach()
mortise_regression(rubber_block RANKS 1 STUDY_RANKS 2)
