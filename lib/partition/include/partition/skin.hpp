// The outer faces of bodies, with or without a name.
#pragma once

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// All faces of this rank's cells that belong to one cell of their body; numbered as in boundary_surface(). Collective.
mesh::Surface outer_surface(const Decomposition& decomposition, const Communicator& comm);

}  // namespace mortise::partition
