// From a place in space to the reference coordinates of a cell (shape_functions.hpp).
#pragma once

#include <span>

#include "mesh/cell.hpp"

namespace mortise::mesh {

/// A place of a cell.
struct CellPlace {
  Eigen::Vector3d reference;  ///< its coordinates in the reference cell
  double distance;            ///< from it to the place that is looked for
};

/// Looks for x in a cell with these nodes, by Newton's method: distance 0 to rounding if x lies in the cell. If it does not, some
/// place of the cell's surface, which is close to x where x is close to the cell.
CellPlace find_in_cell(CellType type, std::span<const Point> nodes, const Point& x);

}  // namespace mortise::mesh
