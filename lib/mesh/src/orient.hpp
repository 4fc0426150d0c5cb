// Cells the right way round: what the order of a cell's nodes says about its inside.
#pragma once

#include "raw_mesh.hpp"

namespace mortise::mesh {

/// Of the model's dimension, not of a surface that stands for the body that it bounds.
inline bool is_solid(CellType type, int dimension)
{
  return mesh::dimension(type) == dimension;
}

/// Turns back cells that are inside out, but for those of surfaces. Throws Error(bad_input), which names the element, where one
/// has no volume or two nodes in one place.
void orient(RawMesh& raw, const Options& options, int dimension);

}  // namespace mortise::mesh
