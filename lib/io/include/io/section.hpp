// Plane sections of cells, and of what closed surfaces enclose.
#pragma once

#include <array>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::io {

struct Section {
  std::vector<Point> points;
  std::vector<std::array<Local, 3>> triangles;
  std::vector<Local> cell;  ///< of each triangle: the one that it is cut out of; 0 in what a surface encloses
};

/// Where the height is zero between the nodes of cells in space; `height`: of each node, zeros count as above. Cells of second
/// order are cut as the linear ones between all of their nodes.
Section cut(const std::vector<Point>& points, const mesh::Cells& cells, const std::vector<double>& height);

/// What closed surfaces of triangles enclose of the plane where the height is zero; `normal` of the plane, unit. Neighbours need
/// not have their corners in common: bands between the heights of corners across one direction of the plane.
Section enclosed(const std::vector<Point>& points, const mesh::Cells& triangles, const std::vector<double>& height,
                 const Point& normal);

/// The triangles halved until no edge is longer than `size`.
Section refined(Section section, double size);

}  // namespace mortise::io
