// Large subdomains in several pieces.
#pragma once

#include "base/communicator.hpp"
#include "partition/decomposition.hpp"

namespace mortise::partition {

/// The same assembly with every subdomain of cells cut by METIS into pieces of about `unknowns` unknowns (as many a node as the
/// model has dimensions), dealt to the ranks with about equal numbers of cells. Skins stay as they are, clusters end. Numbers of
/// nodes and cells stay; neither the pieces nor their numbers depend on the number of ranks. Collective.
Decomposition smaller_subdomains(const Decomposition& decomposition, int unknowns, const Communicator& comm);

}  // namespace mortise::partition
