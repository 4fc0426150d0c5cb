// Contact pressure at the nodes of both sides, for the field of that name.
#pragma once

#include <span>
#include <vector>

#include "contact/mortar.hpp"
#include "contact/state.hpp"
#include "partition/node_directory.hpp"

namespace mortise::output {

/// Of each subdomain, nodes x 1. On the secondary side the recovered pressure; at a node of the primary side that of the place
/// next to it on the secondary one, 0 where the node lies beside that side; of several contacts the largest. Collective.
std::vector<Eigen::MatrixXd> contact_pressure(const partition::Decomposition& decomposition,
                                              const partition::Interface& interface, std::span<const contact::Pair> pairs,
                                              std::span<const contact::SurfaceState> surfaces, const Communicator& comm);

}  // namespace mortise::output
