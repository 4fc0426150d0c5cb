// From a place in space to the reference coordinates of a cell (shape_functions.hpp).
#pragma once

#include <span>

#include "mesh/cell.hpp"

namespace mortise::mesh {

struct CellPlace {
  Eigen::Vector3d reference;  ///< in the reference cell
  double distance;            ///< of the place that has these coordinates from the one that was asked for
};

/// The place x of a cell with these nodes, by Newton's method: distance 0 to rounding if x lies in the cell. If it does not, some
/// place of the cell's surface that is close to x where x is close to the cell.
CellPlace find_in_cell(CellType type, std::span<const Point> nodes, const Point& x);

}  // namespace mortise::mesh
