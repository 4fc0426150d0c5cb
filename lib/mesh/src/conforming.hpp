// Which cells are to be one body, and whether they fit together there.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesh/topology.hpp"
#include "raw_mesh.hpp"

namespace mortise::mesh {

/// The group of each volume and cell: the body of the deck.
struct Groups {
  std::vector<std::string> names;
  std::vector<int> of_cell;
  std::vector<int> label;  ///< cells hang together only if theirs agree
};

Groups group(const RawMesh& raw, const Options& options);

/// Throws Error(bad_input), which names the file and a place, where cells of one group that share the corners of a face see it as
/// faces of different kinds or lie on the same side of it, or whose nodes between these come twice or in another order. The cells
/// are the right way round (orient.hpp); `faces` is their sorted_faces().
void require_conforming(const std::string& file, const RawMesh& raw, std::span<const CellFace> faces, const Groups& groups,
                        int dimension);

}  // namespace mortise::mesh
