// Stresses at integration points and their recovery at nodes.
#pragma once

#include <Eigen/Core>

#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// XX YY ZZ XY YZ XZ.
using Stress = Eigen::Matrix<double, 6, 1>;

/// sqrt(3/2 s:s) of the deviator s.
double von_mises(const Stress& stress);

/// What one piece knows of the stress.
struct StressField {
  /// nodes x 7: sums over the cells of the piece of volume * stress extrapolated to the node, and of the volumes. Added up over the copies of
  /// a node and divided by the last column this is the recovered nodal stress, which never mixes two bodies.
  Eigen::MatrixXd nodal_sums;
  /// Of each cell, from the volume mean of its stress.
  Eigen::VectorXd cell_von_mises;
};
StressField stresses(const mesh::Mesh& mesh, const Material& material, Kinematics kinematics, const Eigen::VectorXd& u);

}  // namespace mortise::fem
