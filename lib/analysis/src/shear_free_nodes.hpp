// Nodes at which no face of their body bears traction along itself: nothing acts there, or along the normals of the faces alone.
#pragma once

#include <vector>

#include "analysis/rows.hpp"
#include "partition/node_homes.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::analysis {

/// With the normals of the faces that meet there, those of a curved surface in one; not at reentrant edges, where stress has no
/// limit, nor where contacts, bonds, couplings or other supports have rows. Of each subdomain of this rank. `homes` knows the
/// nodes in the rows of contacts. Collective.
std::vector<std::vector<post::SymmetricNode>> find_shear_free_nodes(const model::Model& model, const Rows& rows,
                                                                    const partition::NodeHomes& homes, const Communicator& comm);

}  // namespace mortise::analysis
