// Every body in one piece.
#pragma once

#include "base/communicator.hpp"
#include "partition/decomposition.hpp"

namespace mortise::partition {

/// The same assembly with one subdomain a body, dealt to the ranks with about equal numbers of cells. Bodies of skins stay as
/// they are cut: what is known by its surface cannot be joined. Numbers of nodes and cells stay. Collective.
Decomposition whole_bodies(const Decomposition& decomposition, const Communicator& comm);

}  // namespace mortise::partition
