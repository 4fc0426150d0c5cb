// How large a face is, and which way it looks.
#pragma once

#include <span>
#include <vector>

#include "mesh/cell.hpp"
#include "mesh/mesh.hpp"

namespace mortise::mesh {

/// Of a face with these nodes: its area along its normal, which points to where the corners run round it counterclockwise; of a
/// curved one, of the flat faces through its corners. Of an edge of a plane mesh: its length, to the right of its direction.
Point area_vector(const std::vector<Point>& points, std::span<const Local> nodes, CellType type);

}  // namespace mortise::mesh
