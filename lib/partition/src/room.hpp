// Whether the mesh itself fits into memory, before it is made: a few wrong digits in a deck ask for any number of cells.
#pragma once

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise::partition {

/// Throws Error(machine) if so many nodes and cells, of all instances, spread over the ranks, need more memory than the machines
/// have. Collective.
void require_room(Global nodes, Global cells, const Communicator& comm);

}  // namespace mortise::partition
