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

/// The section of cells in space where `height`, given at each node and linear between nodes, is zero; nodes with height zero
/// count as above. Cells of second order are cut as linear cells between all of their nodes.
Section cut(const std::vector<Point>& points, const mesh::Cells& cells, const std::vector<double>& height);

/// The part of the plane where the height is zero that closed surfaces of triangles enclose; `normal`: of the plane, unit. Its
/// triangles fill bands between corners across one direction of the plane, so that neighbours need not have corners in common.
Section enclosed(const std::vector<Point>& points, const mesh::Cells& triangles, const std::vector<double>& height,
                 const Point& normal);

/// The triangles halved until no edge is longer than `size`.
Section refined(Section section, double size);

}  // namespace mortise::io
