// Nodes of a bonded sector's cuts that are one with nodes of the other cut.
#pragma once

#include <vector>

#include "analysis/rows.hpp"
#include "partition/node_directory.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::analysis {

/// Of each subdomain of this rank, ascending, those whose bond has rows u(secondary) = R u(primary) for one node, of any body;
/// none at all if no rank has any. Where meshes do not match there are none, nor where supports hold all of a node. Collective.
std::vector<std::vector<post::RotatedNode>> find_rotated_nodes(const Rows& rows, const partition::Decomposition& decomposition,
                                                             const partition::NodeDirectory& directory, const Communicator& comm);

}  // namespace mortise::analysis
