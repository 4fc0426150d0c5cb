// The outer faces of bodies, with or without a name.
#pragma once

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// All faces of this rank's cells that belong to one cell of their body; numbered as in boundary_surface(). Collective.
mesh::Surface outer_surface(const Decomposition& decomposition, const Communicator& comm);

/// Of a facet of a boundary: its cell's number and its place among the cell's faces, which are at most six, tell faces apart on
/// every number of ranks.
Global face_number(const mesh::Mesh& mesh, std::size_t facet);

}  // namespace mortise::partition
