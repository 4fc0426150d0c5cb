// Planes through nodes, told to the subdomains that have copies of these.
#pragma once

#include <span>
#include <vector>

#include "partition/node_homes.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::analysis {

/// The planes with the unit normals `normals[i]` of the nodes `nodes[i]`, which are at home on this rank, at all of their copies:
/// of each subdomain of this rank, ascending. `tractions`: along the normals, none or one for each. Collective.
std::vector<std::vector<post::SymmetricNode>> planes_at_copies(std::span<const Global> nodes,
                                                               std::span<const std::vector<Point>> normals,
                                                               const partition::Decomposition& decomposition,
                                                               const partition::NodeHomes& homes, const Communicator& comm,
                                                               std::span<const std::vector<double>> tractions = {});

}  // namespace mortise::analysis
