// Whether the mesh itself fits into memory, before it is made: a few wrong digits in a deck ask for any number of cells.
#pragma once

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"

namespace mortise::partition {

/// Throws Error(machine) if the nodes and cells of `catalogue`, spread over the ranks, need more memory than the machines have.
/// Collective.
void require_room(const mesh::Catalogue& catalogue, const Communicator& comm);

}  // namespace mortise::partition
