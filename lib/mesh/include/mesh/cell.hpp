// The shapes of cells and of their faces: first-order Lagrange cells, their nodes in gmsh's (= VTK's) order.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/types.hpp"

namespace mortise::mesh {

enum class CellType : std::uint8_t { line2, tri3, quad4, tet4, hex8, prism6 };

/// A face (3D) or edge (2D) of a cell: its own shape and the cell's local nodes, in the order that makes its normal point out
/// of the cell (2D: the outward normal of the edge a -> b is (b_y - a_y, a_x - b_x), so cells run counter-clockwise).
struct Face {
  CellType type;
  std::vector<int> nodes;
};

int dimension(CellType type);          ///< 1 line2; 2 tri3, quad4; 3 tet4, hex8, prism6
int node_count(CellType type);         ///< nodes a cell
std::string_view name(CellType type);  ///< "hex8", as the deck spells it
const std::vector<Face>& faces(CellType type);

/// Many cells of mixed types in compressed rows: cell i has the local node indices nodes[offset[i] .. offset[i+1]).
struct Cells {
  std::vector<CellType> type;
  std::vector<Local> offset{0};
  std::vector<Local> nodes;

  std::size_t size() const { return type.size(); }
  std::span<const Local> operator[](std::size_t i) const
  {
    return {nodes.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
  void add(CellType cell_type, std::span<const Local> cell_nodes)
  {
    type.push_back(cell_type);
    nodes.insert(nodes.end(), cell_nodes.begin(), cell_nodes.end());
    offset.push_back(static_cast<Local>(nodes.size()));
  }
};

}  // namespace mortise::mesh
