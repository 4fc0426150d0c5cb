// Values at the nodes of cells, read off anywhere on them or beside them.
#pragma once

#include <memory>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::io {

/// Cells of VTK's types, as plain arrays.
struct CellArrays {
  std::vector<double> points, values;            ///< three coordinates, one value a point
  std::vector<long long> offsets, connectivity;  ///< cell c has the points connectivity[offsets[c]] .. [offsets[c + 1] - 1]
  std::vector<unsigned char> types;

  /// Appends cells with points of their own.
  void add(const std::vector<Point>& at, const std::vector<double>& value, mesh::CellType type);
};

class CellField {
 public:
  /// At least one cell.
  explicit CellField(CellArrays arrays);

  struct Nearest {
    double value = 0;  ///< by the shape functions of the cell
    Point at;          ///< a place of the cells next to x: x, if it lies in one
    double distance;   ///< from x
    std::size_t cell;
    double size;  ///< of that cell, its diagonal
  };
  /// The value at the place of all cells that is nearest to x.
  Nearest nearest(const Point& x) const;

 private:
  struct Locator;
  std::shared_ptr<Locator> locator_;
};

}  // namespace mortise::io
