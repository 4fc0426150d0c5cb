// Rigid motions in a result: a body that is held by next to nothing goes far and hardly deforms.
#pragma once

#include <vector>

#include "feti/free_motions.hpp"
#include "post/verdict.hpp"

namespace mortise::post {

/// The rigid motion that comes nearest to a body's displacements, by least squares over its nodes.
struct BodyMotion {
  feti::RigidMotion rigid;
  double turning = 0;  ///< its rotation, a length: times the body's radius
  double rest = 0;     ///< root mean square of what it leaves of the displacements
};
/// Of each body. Collective.
std::vector<BodyMotion> rigid_motions(const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                      const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

/// The largest rigid motion of a body over its size, fitted to its displacements by least squares, less `allowance`, a length
/// that supports, gaps and overlaps account for. `sizes`: of the bodies, see body_sizes(). Collective.
Drift drift(const partition::Decomposition& decomposition, fem::Kinematics kinematics, const std::vector<double>& sizes,
            const std::vector<Eigen::VectorXd>& displacement, double allowance, const Communicator& comm);

}  // namespace mortise::post
