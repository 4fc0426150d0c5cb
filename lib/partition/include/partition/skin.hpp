// The outer faces of bodies, with or without a name.
#pragma once

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// All faces of this rank's cells that belong to one cell of their body, of skins the panels that belong to one skin of their
/// body; numbered as in boundary_surface(). Collective.
mesh::Surface outer_surface(const Decomposition& decomposition, const Communicator& comm);

/// Of a facet of a boundary: six times its cell's number and its place among the cell's faces, which are at most six, tell faces
/// apart on every number of ranks. A panel of a skin is its own face, at place 0.
Global face_number(const mesh::Mesh& mesh, std::size_t facet);

/// The shape of a face of a cell and its nodes in the subdomain's mesh; of a skin the panel itself.
struct FaceOfCell {
  mesh::CellType type;
  std::vector<Local> nodes;
};
/// `face`: its place among the cell's faces, mesh::faces().
FaceOfCell face_of(const Subdomain& subdomain, Local cell, int face);

}  // namespace mortise::partition
