// The shapes of cells and of their faces: Lagrange and serendipity cells of first and second order, their nodes in gmsh's order:
// corners, then the middles of edges, of faces and of the cell.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/types.hpp"

namespace mortise::mesh {

enum class CellType : std::uint8_t {
  line2,
  tri3,
  quad4,
  tet4,
  hex8,
  prism6,
  line3,
  tri6,
  quad8,
  quad9,
  tet10,
  hex20,
  hex27,
  prism15,
  prism18
};
inline constexpr std::size_t cell_types = 15;

/// A face (3D) or edge (2D) of a cell: its own shape and the cell's local nodes, in the order that makes its normal point out
/// of the cell (2D: the outward normal of the edge a -> b is (b_y - a_y, a_x - b_x), so cells run counter-clockwise). Corners
/// come first.
struct Face {
  CellType type;
  std::vector<int> nodes;
};

int dimension(CellType type);         ///< 1 of lines, 2 of triangles and quadrilaterals, else 3
int node_count(CellType type);        ///< nodes of a cell
int corner_count(CellType type);      ///< nodes of the first-order cell of that shape
CellType first_order(CellType type);  ///< hex8 for hex27
/// Whether it has nodes in the middle of its edges.
inline bool second_order(CellType type)
{
  return type != first_order(type);
}
std::string_view name(CellType type);  ///< "hex8", as the deck spells it
/// The type that the deck spells so; nothing if there is none.
std::optional<CellType> cell_type(std::string_view name);
/// The faces (2D: edges) of a cell; none of a line.
const std::vector<Face>& faces(CellType type);

/// For each node after the corners the corners that it lies amid: two for an edge, four for a face, eight for a cell. Ascending.
const std::vector<std::vector<int>>& middles(CellType type);
/// The node amid these corners (ascending), or the corner itself if there is one; -1 if there is none.
int node_amid(CellType type, std::span<const int> corners);

/// Many cells of mixed types in compressed rows: cell i has the local node indices nodes[offset[i] .. offset[i+1]).
struct Cells {
  std::vector<CellType> type;
  std::vector<Local> offset{0};
  std::vector<Local> nodes;

  std::size_t size() const { return type.size(); }  ///< number of cells
  /// The nodes of the i-th cell.
  std::span<const Local> operator[](std::size_t i) const
  {
    return {nodes.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
  /// One more cell, with node_count(cell_type) nodes.
  void add(CellType cell_type, std::span<const Local> cell_nodes)
  {
    type.push_back(cell_type);
    nodes.insert(nodes.end(), cell_nodes.begin(), cell_nodes.end());
    offset.push_back(static_cast<Local>(nodes.size()));
  }
  bool operator==(const Cells&) const = default;
};

}  // namespace mortise::mesh
