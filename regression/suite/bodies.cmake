# Boundaries coupled to points, which are loaded, held, or both.
mortise_regression(coupling_bending RANKS 3 STUDY_RANKS 1 2)
mortise_regression(coupling_held RANKS 1 STUDY_RANKS 2 3)
foreach(deck coupling_bending coupling_held)
  mortise_regression(${deck} VARIANT .rigid RANKS 1 STUDY_RANKS 2 SET couplings.grip.kind=rigid)
  mortise_regression(${deck} VARIANT .direct RANKS 1 SET solver.algorithm=direct couplings.grip.kind=rigid)
endforeach()
mortise_regression(coupling_steps RANKS 1 2 3)
mortise_regression(coupling_far RANKS 2 STUDY_RANKS 1)
mortise_regression(coupling_bending VARIANT .axes RANKS 1 STUDY_RANKS 2 SET "axes={turned: {x: [0, 1, 0], y: [-1, 0, 0]}}"
  "loads[0]={coupling: grip, axes: turned, moment: [0.5, 0, 0]}")
mortise_regression(coupling_steps VARIANT .axes RANKS 1 STUDY_RANKS 2 SET "axes={turned: {x: [0, 1, 0]}}"
  "loads[1]={name: pulled, coupling: grip, axes: turned, force: [0, -3]}")

# Bodies that turn; loads by formulas.
mortise_regression(turning_bar RANKS 1 STUDY_RANKS 2)
mortise_regression(turning_ring RANKS 1)
mortise_regression(graded_pressure RANKS 1 STUDY_RANKS 2)
mortise_regression(formula_steps RANKS 1 STUDY_RANKS 2)
mortise_regression(linear_field RANKS 1 2 3)
mortise_regression(warm_gradient RANKS 1 STUDY_RANKS 2)
mortise_regression(steps_hysteresis VARIANT .formula RANKS 1 STUDY_RANKS 2 SET "supports[1].displacement.x=0.05 + 0 * y")

# Local axes, points.
mortise_regression(twisted_shaft RANKS 1 STUDY_RANKS 3)
mortise_regression(local_tractions RANKS 1 STUDY_RANKS 2 3)

# Elastic foundations, springs between points: formulas.
foreach(deck temperature_files foundation_block)
  mortise_regression(${deck} RANKS 3 STUDY_RANKS 1 2)
endforeach()
foreach(deck local_results orthotropic_beam orthotropic_block orthotropic_tube named_points named_curves foundation_bar foundation_ring)
  mortise_regression(${deck} RANKS 1 STUDY_RANKS 2 3)
endforeach()
foreach(deck temperature_files orthotropic_tube named_points foundation_bar foundation_block)
  mortise_regression(${deck} VARIANT .direct RANKS 1 SET solver.algorithm=direct)
  mortise_regression(${deck} VARIANT .dirichlet RANKS 1 SET solver.preconditioner=dirichlet)
endforeach()
foreach(deck local_results orthotropic_beam orthotropic_block named_curves foundation_ring)  # of the same kinds
  mortise_regression(${deck} VARIANT .direct STUDY_RANKS 1 SET solver.algorithm=direct)
  mortise_regression(${deck} VARIANT .dirichlet STUDY_RANKS 1 SET solver.preconditioner=dirichlet)
endforeach()
mortise_regression(orthotropic_copies RANKS 2 STUDY_RANKS 1)
mortise_regression(orthotropic_copies VARIANT .dirichlet RANKS 1 SET solver.preconditioner=dirichlet)
mortise_regression(orthotropic_tube VARIANT .copies EXPECTED cases/orthotropic_tubes.expected.json RANKS 1
                   SET "bodies.ring.instances=[{count: 2, rotate: {angle: 35, center: [4, 1, 0]}}]"
                       "supports[0].displacement={normal: 0}" "supports[1].displacement={normal: 0}")
mortise_regression(foundation_rings RANKS 1 STUDY_RANKS 2)
mortise_regression(foundation_pile RANKS 1 STUDY_RANKS 2)
mortise_regression(foundation_block VARIANT .boundary RANKS 1 SET bodies.block.method=boundary_elements mesh.blocks.block.element=hex8)
mortise_regression(foundation_block VARIANT .smalse RANKS 1 SET solver.algorithm=smalse)
mortise_regression(foundation_block VARIANT .clusters RANKS 2 SET "decomposition={unknowns_per_subdomain: 60, subdomains_per_cluster: 4}")
mortise_regression(friction_held RANKS 1 STUDY_RANKS 2)
mortise_regression(ladder RANKS 1)
mortise_regression(pascals RANKS 1 STUDY_RANKS 2)
mortise_regression(brick_wall RANKS 1 STUDY_RANKS 2)
mortise_regression(brick_wall VARIANT .fine RANKS 1 SET solver.tolerance=1e-9)
mortise_regression(held_face RANKS 2 STUDY_RANKS 1 3)
mortise_regression(held_face VARIANT .bonded RANKS 2 SET "contacts[0].friction={bonded: true}")
mortise_regression(held_face_driven RANKS 1 STUDY_RANKS 3)
mortise_regression(foundation_contact RANKS 1 2 3)
mortise_regression(foundation_contact VARIANT .direct RANKS 1 2 3 SET solver.algorithm=direct)
mortise_regression(lifted_on_springs RANKS 1 STUDY_RANKS 2)
mortise_regression(lifted_on_springs VARIANT .residual RANKS 1 SET solver.tolerance=1e-6)
mortise_regression(lifted_on_springs VARIANT .direct RANKS 1 SET solver.algorithm=direct)

# What a deck cuts too coarsely is cut anew.
mortise_regression(large_subdomain RANKS 1 STUDY_RANKS 3)

mortise_regression(coupling_rigid_body RANKS 1 STUDY_RANKS 3)
mortise_regression(coupling_punch RANKS 1 STUDY_RANKS 2)
mortise_regression(coupling_cap RANKS 2 STUDY_RANKS 1 3)
mortise_regression(coupling_cap VARIANT .face_newton RANKS 2 SET solver.algorithm=face_newton)

# Boundary elements: beside finite elements, with Coulomb friction (against hex20 of eight times as many cells), weight and warmth,
# bodies from closed surfaces.
mortise_regression(boundary_patch RANKS 1 2 3)
mortise_regression(boundary_coulomb RANKS 1 STUDY_RANKS 2)
mortise_regression(boundary_weight RANKS 1 STUDY_RANKS 3)
mortise_regression(boundary_surfaces RANKS 1 STUDY_RANKS 2 3)
mortise_regression(boundary_patch VARIANT .smalse RANKS 1 STUDY_RANKS 2 SET solver.algorithm=smalse)
mortise_regression(boundary_coulomb VARIANT .smalse STUDY_RANKS 2 SET solver.algorithm=smalse)

# Inside bodies: the wall of a hollow sphere, below a point contact, on both sides of a bond; in planes below a line contact, in a ring.
mortise_regression(interior_sphere STUDY_RANKS 1)
mortise_regression(interior_sphere VARIANT .cut RANKS 1 STUDY_RANKS 2 3 EXPECTED cases/interior_sphere_cut.expected.json SET decomposition.subdomains=4)
mortise_regression(interior_hertz RANKS 1 STUDY_RANKS 2)
mortise_regression(interior_steps RANKS 3 STUDY_RANKS 1 2)
mortise_regression(interior_plane_hertz RANKS 1 STUDY_RANKS 2)
mortise_regression(interior_plane_ring RANKS 1)
mortise_regression(interior_plane_ring VARIANT .stress EXPECTED cases/interior_plane_ring_stress.expected.json RANKS 1
                   SET dimension=plane_stress)

# Extremes, points and paths through load steps, reactions and their moments; which states and fields are written.
mortise_regression(probes_cantilever RANKS 1 2 3)

# In planes: the same (friction against quad9 of sixteen times as many cells, weight and warmth by a formula), a ring, Hertz's line contact.
foreach(plane plane_strain plane_stress)
  mortise_regression(patch_${plane} VARIANT .boundary RANKS 1 STUDY_RANKS 3 SET bodies.upper.method=boundary_elements)
endforeach()
mortise_regression(boundary_plane_coulomb RANKS 1 STUDY_RANKS 2)
mortise_regression(boundary_plane_weight RANKS 1 STUDY_RANKS 2 3)
mortise_regression(sector_ring VARIANT .boundary EXPECTED cases/boundary_sector_ring.expected.json RANKS 1 STUDY_RANKS 2
                   SET bodies.ring.method=boundary_elements mesh.constants.n=8)
mortise_regression(hertz_cylinder VARIANT .boundary DIRECTORY ../inputs/hertz_cylinder EXPECTED cases/boundary_hertz_cylinder.expected.json
                   RANKS 1 STUDY_RANKS 3
                   SET bodies.block.method=boundary_elements bodies.cylinder.method=boundary_elements "decomposition={subdomains: 7}")

# Changes of temperature: free, held, shrunk on, two metals.
mortise_regression(thermal_free RANKS 1 STUDY_RANKS 2)
mortise_regression(thermal_free VARIANT .direct RANKS 2 STUDY_RANKS 1 SET solver.algorithm=direct)
mortise_regression(thermal_bar RANKS 1 STUDY_RANKS 3)
mortise_regression(shrink_fit RANKS 1 STUDY_RANKS 2)
mortise_regression(shrink_fit VARIANT .plane_strain EXPECTED cases/shrink_fit_plane_strain.expected.json RANKS 1
                   SET dimension=plane_strain)
mortise_regression(shrink_fit_axisymmetric RANKS 1 STUDY_RANKS 2)
mortise_regression(bimetal RANKS 1 STUDY_RANKS 2)

# Preloaded bolts.
mortise_regression(preload_bar RANKS 1 2 3)
mortise_regression(preload_joint RANKS 1 STUDY_RANKS 2)
mortise_regression(quarter_bolt RANKS 1 STUDY_RANKS 2 3)
mortise_regression(quarter_bolt VARIANT .sector EXPECTED cases/quarter_bolt.sector.expected.json RANKS 1 STUDY_RANKS 2 3
  SET "supports=[{boundary: foot, displacement: {z: 0}}, {boundary: top, displacement: {z: 0}}]"
      "contacts=[{name: cut, secondary: under, primary: over, friction: {bonded: true}, preload: {force: 100}}, \
{name: shank, secondary: shank:across_x, primary: shank:across_y, friction: {bonded: true}, cyclic: {angle: 90}}, \
{name: head, secondary: head:across_x, primary: head:across_y, friction: {bonded: true}, cyclic: {angle: 90}}]")
mortise_regression(preload_locked RANKS 1)
mortise_regression(preload_two_bolts RANKS 3 STUDY_RANKS 1)
foreach(deck preload_bar preload_joint)
  mortise_regression(${deck} VARIANT .smalse RANKS 1 STUDY_RANKS 2 SET solver.algorithm=smalse)
endforeach()
mortise_regression(preload_two_bolts VARIANT .smalse STUDY_RANKS 2 SET solver.algorithm=smalse)

# Supports along normals.
mortise_regression(sector_ring RANKS 1 STUDY_RANKS 3)
mortise_regression(torque_on_sectors RANKS 1 STUDY_RANKS 3)
mortise_regression(torque_on_sectors VARIANT .turned EXPECTED cases/torque_on_sectors.turned.expected.json RANKS 1 STUDY_RANKS 2
  SET "supports=[{boundary: bore, displacement: {x: 0, y: 0}}, {coupling: rim, rotation: {z: 0.0186211}}]" loads=[])
mortise_regression(torque_on_sectors VARIANT .nearly EXPECTED cases/torque_on_sectors.expected.json RANKS 1 SET couplings.rim.point=[1e-6,0,0])
mortise_regression(torque_on_sectors VARIANT .rigid EXPECTED cases/torque_on_sectors.expected.json RANKS 1 SET couplings.rim.kind=rigid)
mortise_regression(sector_fit RANKS 1 STUDY_RANKS 2)
mortise_regression(cone_sector RANKS 1 STUDY_RANKS 2)
mortise_regression(cone_in_cone RANKS 1 STUDY_RANKS 2 3)
mortise_regression(cone_in_cone VARIANT .second_order STUDY_RANKS 1 SET mesh.order=2)
mortise_regression(coarse_ring_fit RANKS 1 STUDY_RANKS 2 3)
mortise_regression(coarse_ring_fit VARIANT .swapped STUDY_RANKS 1 SET contacts.0.secondary=journal contacts.0.primary=bore)

mortise_regression(step_tube RANKS 1 STUDY_RANKS 2)
