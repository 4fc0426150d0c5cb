// The outer faces of bodies, with or without a name.
#pragma once

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// All faces of this rank's cells that belong to one cell of their body, of skins the panels that belong to one skin of their
/// body; numbered as in boundary_surface(). Collective.
mesh::Surface outer_surface(const Decomposition& decomposition, const Communicator& comm);

/// The number of the face that a facet of a boundary is: six times the number of its cell, which has six faces at most, plus its
/// place among the cell's faces, whatever the number of ranks. A panel of a skin is its own face, at place 0.
Global face_number(const mesh::Mesh& mesh, std::size_t facet);

/// The shape of a face of a cell and its nodes in the subdomain's mesh; of a skin the panel itself.
struct FaceOfCell {
  mesh::CellType type;
  std::vector<Local> nodes;
};
/// `face`: its place among the cell's faces, mesh::faces().
FaceOfCell face_of(const Subdomain& subdomain, Local cell, int face);

}  // namespace mortise::partition
