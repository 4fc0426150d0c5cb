// Which bodies feel each other.
#pragma once

#include <vector>

#include "feti/jump_operator.hpp"

namespace mortise::feti {

/// Bodies that rows of B or unknown motions of rigid couplings tie to each other, directly or through others. What acts on one
/// group is nothing to the others, so sizes of one are no measure for another. A group has the number of its lowest body.
struct BodyGroups {
  std::vector<int> of_body;  ///< the same on every rank
  std::vector<int> of_row;   ///< of each owned row; -1 for one without entries
};

/// `prescribed`: those of `jump`. Collective.
BodyGroups body_groups(const partition::Decomposition& decomposition, const JumpOperator& jump,
                       std::span<const constraint::PrescribedDof> prescribed, const Communicator& comm);

}  // namespace mortise::feti
