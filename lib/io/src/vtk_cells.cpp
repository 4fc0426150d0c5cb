#include "vtk_cells.hpp"

#include <vtkCellType.h>

#include <numeric>

namespace mortise::io {

namespace {

// The corners, numbered as VTK does, amid which VTK's nodes after the corners lie. A cell takes as many of them as it has nodes.
const std::vector<std::vector<int>>& vtk_middles(mesh::CellType type)
{
  using enum mesh::CellType;
  static const std::vector<std::vector<int>> line{{0, 1}}, triangle{{0, 1}, {1, 2}, {2, 0}},
      quadrilateral{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}}, tetrahedron{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
      hexahedron{{0, 1},
                 {1, 2},
                 {2, 3},
                 {3, 0},
                 {4, 5},
                 {5, 6},
                 {6, 7},
                 {7, 4},
                 {0, 4},
                 {1, 5},
                 {2, 6},
                 {3, 7},
                 {0, 3, 7, 4},
                 {1, 2, 6, 5},
                 {0, 1, 5, 4},
                 {3, 2, 6, 7},
                 {0, 1, 2, 3},
                 {4, 5, 6, 7},
                 {0, 1, 2, 3, 4, 5, 6, 7}},
      wedge{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  switch (mesh::first_order(type)) {
    case line2:
      return line;
    case tri3:
      return triangle;
    case quad4:
      return quadrilateral;
    case tet4:
      return tetrahedron;
    case hex8:
      return hexahedron;
    default:
      return wedge;
  }
}

// The node of the cell that stands at each place of VTK's cell. VTK's wedge has its triangles the other way round.
std::vector<int> order_in_vtk(mesh::CellType type)
{
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  std::vector<int> order(corners);
  std::iota(order.begin(), order.end(), 0);
  if (mesh::first_order(type) == mesh::CellType::prism6) order = {0, 2, 1, 3, 5, 4};
  for (const auto& amid : vtk_middles(type)) {
    if (order.size() == static_cast<std::size_t>(mesh::node_count(type))) break;
    std::vector<int> own;
    for (const int c : amid) own.push_back(order[static_cast<std::size_t>(c)]);
    order.push_back(mesh::node_amid(type, own));
  }
  return order;
}

}  // namespace

int vtk_type(mesh::CellType type)
{
  using enum mesh::CellType;
  switch (type) {
    case line2:
      return VTK_LINE;
    case tri3:
      return VTK_TRIANGLE;
    case quad4:
      return VTK_QUAD;
    case tet4:
      return VTK_TETRA;
    case hex8:
      return VTK_HEXAHEDRON;
    case prism6:
      return VTK_WEDGE;
    case line3:
      return VTK_QUADRATIC_EDGE;
    case tri6:
      return VTK_QUADRATIC_TRIANGLE;
    case quad8:
      return VTK_QUADRATIC_QUAD;
    case quad9:
      return VTK_BIQUADRATIC_QUAD;
    case tet10:
      return VTK_QUADRATIC_TETRA;
    case hex20:
      return VTK_QUADRATIC_HEXAHEDRON;
    case hex27:
      return VTK_TRIQUADRATIC_HEXAHEDRON;
    case prism15:
      return VTK_QUADRATIC_WEDGE;
    case prism18:
      return VTK_BIQUADRATIC_QUADRATIC_WEDGE;
  }
  return VTK_EMPTY_CELL;
}

std::vector<vtkIdType> vtk_nodes(mesh::CellType type, std::span<const Local> nodes)
{
  static const auto orders = [] {
    std::vector<std::vector<int>> all;
    for (std::size_t t = 0; t < mesh::cell_types; ++t) all.push_back(order_in_vtk(static_cast<mesh::CellType>(t)));
    return all;
  }();
  std::vector<vtkIdType> result;
  for (const int n : orders[static_cast<std::size_t>(type)]) result.push_back(nodes[static_cast<std::size_t>(n)]);
  return result;
}

}  // namespace mortise::io
