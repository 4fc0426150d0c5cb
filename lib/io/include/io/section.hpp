// Plane sections of cells.
#pragma once

#include <array>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::io {

struct Section {
  std::vector<Point> points;
  std::vector<std::array<Local, 3>> triangles;
  std::vector<Local> cell;  ///< of each triangle: the one that it is cut out of
};

/// Where the height is zero between the nodes of cells in space; `height`: of each node, zeros count as above. Cells of second
/// order are cut as the linear ones between all of their nodes.
Section cut(const std::vector<Point>& points, const mesh::Cells& cells, const std::vector<double>& height);

/// The triangles halved until no edge is longer than `size`.
Section refined(Section section, double size);

}  // namespace mortise::io
