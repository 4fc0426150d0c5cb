// Rigid motions in a result: a body that is held by next to nothing goes far and hardly deforms.
#pragma once

#include <vector>

#include "feti/free_motions.hpp"
#include "post/verdict.hpp"

namespace mortise::post {

/// The body whose displacements are, by least squares, the largest rigid motion over its size, less `allowance`, a length that
/// supports, gaps and overlaps account for. Collective.
Drift drift(const partition::Decomposition& decomposition, fem::Kinematics kinematics, const std::vector<double>& sizes,
            const std::vector<Eigen::VectorXd>& displacement, double allowance, const Communicator& comm);

}  // namespace mortise::post
