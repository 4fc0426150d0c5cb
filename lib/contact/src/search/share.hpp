// Who works on what: every rank gets a share of the secondary faces that lies together, what lies round them, and what they can
// meet. It works out the rows of its own nodes alone, and what it needs of its neighbours' faces once more, so that nothing is
// exchanged afterwards and no sum depends on the ranks.
#pragma once

#include "search/near.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

struct Share {
  Side secondary, primary;
  std::vector<char> own;  ///< of each secondary node: this rank makes its rows
};

/// Of the faces of both sides that can meet, this rank's equal share: cut in halves across the longest side again and again. A
/// node belongs to the rank of the face with the smallest number round it. Collective.
Share share_out(const Pair& pair, const PairSize& size, fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
