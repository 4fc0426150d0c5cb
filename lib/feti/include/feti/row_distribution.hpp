// Where rows stand: those of a support or a contact node on the rank of the lowest subdomain that holds a copy of their node, of
// contacts the secondary one. Gluing rows stand there as well, so that products with B send between neighbours alone.
#pragma once

#include <span>
#include <vector>

#include "constraint/constraints.hpp"
#include "partition/decomposition.hpp"
#include "partition/node_directory.hpp"

namespace mortise::feti {

/// The supports of all ranks, each on the rank of its row; ascending by node and component. Collective.
std::vector<constraint::PrescribedDof> distribute_rows(std::span<const constraint::PrescribedDof> prescribed,
                                                       const partition::Decomposition& decomposition,
                                                       const partition::NodeDirectory& directory, const Communicator& comm);

/// The same of skew supports: ascending by node, those of a node in the order that they had. Collective.
std::vector<constraint::SkewSupport> distribute_rows(std::span<const constraint::SkewSupport> skew_supports,
                                                     const partition::Decomposition& decomposition,
                                                     const partition::NodeDirectory& directory, const Communicator& comm);

/// The contact nodes of all ranks with their rows and prescribed entries, each on the rank of its rows, in the order of the ranks
/// that they come from. For contacts that have slipped nowhere yet; pretension sections have to be found anew. Collective.
constraint::Contacts distribute_rows(const constraint::Contacts& contacts, const partition::Decomposition& decomposition,
                                     const partition::NodeDirectory& directory, const Communicator& comm);

/// The places in `rows`, which every rank has, of the rows that stand on this rank, that of their first node. Collective.
std::vector<std::size_t> rows_here(std::span<const constraint::SpringRow> rows, const partition::Decomposition& decomposition,
                                   const partition::NodeDirectory& directory, const Communicator& comm);

}  // namespace mortise::feti
