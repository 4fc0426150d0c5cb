// Local stiffness of a piece of the mesh, and its kernel from geometry.
#pragma once

#include <Eigen/SparseCore>
#include <span>

#include "fem/materials.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// Lame's constants of an isotropic material as the kinematics sees them: in plane stress lambda is 2 lambda mu / (lambda + 2
/// mu).
struct Lame {
  double lambda, mu;
};
/// Lame's constants, in the unit of Young's modulus.
Lame lame(const Material& material, Kinematics kinematics);

/// Lower triangle of K, K_ij = integral of lambda div v_i div v_j + 2 mu e(v_i):e(v_j), full integration, lambda and mu
/// those of the cell, or of e(v_i) : C : e(v_j); other formulations as they have it. Unknown d * node + component, d =
/// dimension(kinematics). In axisymmetry the hoop strain u_r / r counts as well. Throws Error(bad_input) that names the cell if
/// its Jacobian is not positive at an integration point.
Eigen::SparseMatrix<double, Eigen::ColMajor, int> stiffness(const mesh::Mesh& mesh, const Materials& materials,
                                                            Kinematics kinematics,
                                                            Formulation formulation = Formulation::standard);

/// How many rigid motions there are: 6 in space, 3 in a plane, in axisymmetry 1, along the axis.
int rigid_motion_count(Kinematics kinematics);

/// Orthonormal basis of the rigid motions of the points, (d points) x rigid_motion_count(); translations first, then rotations
/// about the centroid.
Eigen::MatrixXd rigid_motions(std::span<const Point> points, Kinematics kinematics);

}  // namespace mortise::fem
