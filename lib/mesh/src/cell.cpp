#include "mesh/cell.hpp"

#include <algorithm>
#include <array>

namespace mortise::mesh {

namespace {

using enum CellType;
using Middles = std::vector<std::vector<int>>;

// To add a cell: a row in table(), its name in CellType, its space of polynomials in shape_functions.cpp and its element in fem.
struct Shape {
  std::string_view name;
  int dimension;
  CellType first_order;
  int corners;
  Middles middles;
  std::vector<Face> faces;
};

int amid(const Shape& shape, std::vector<int> corners)
{
  std::sort(corners.begin(), corners.end());
  if (corners.size() == 1) return corners[0];
  const auto found = std::find(shape.middles.begin(), shape.middles.end(), corners);
  return found == shape.middles.end() ? -1 : shape.corners + static_cast<int>(found - shape.middles.begin());
}

Shape first(std::string_view name, int dimension, CellType type, int corners, std::vector<Face> faces)
{
  return {name, dimension, type, corners, {}, std::move(faces)};
}

// The faces follow from those of the first-order cell: their corners, and the cell's nodes amid these.
Shape second(std::string_view name, const Shape& linear, Middles middles, const std::array<const Shape*, 3>& face_shapes,
             const std::array<CellType, 3>& face_types)
{
  for (auto& corners : middles) std::sort(corners.begin(), corners.end());
  Shape shape{name, linear.dimension, linear.first_order, linear.corners, std::move(middles), {}};
  for (const auto& face : linear.faces) {
    const auto kind = static_cast<std::size_t>(face.type == line2 ? 0 : face.type == tri3 ? 1 : 2);
    Face result{face_types[kind], face.nodes};
    for (const auto& on_face : face_shapes[kind]->middles) {
      std::vector<int> corners;
      for (const int c : on_face) corners.push_back(face.nodes[static_cast<std::size_t>(c)]);
      result.nodes.push_back(amid(shape, corners));
    }
    shape.faces.push_back(std::move(result));
  }
  return shape;
}

std::array<Shape, cell_types> make_table()
{
  const Shape line = first("line2", 1, line2, 2, {});
  const Shape tri = first("tri3", 2, tri3, 3, {{line2, {0, 1}}, {line2, {1, 2}}, {line2, {2, 0}}});
  const Shape quad = first("quad4", 2, quad4, 4, {{line2, {0, 1}}, {line2, {1, 2}}, {line2, {2, 3}}, {line2, {3, 0}}});
  const Shape tet = first("tet4", 3, tet4, 4, {{tri3, {0, 2, 1}}, {tri3, {0, 1, 3}}, {tri3, {1, 2, 3}}, {tri3, {0, 3, 2}}});
  const Shape hex = first("hex8", 3, hex8, 8,
                          {{quad4, {0, 3, 2, 1}},
                           {quad4, {4, 5, 6, 7}},
                           {quad4, {0, 1, 5, 4}},
                           {quad4, {1, 2, 6, 5}},
                           {quad4, {2, 3, 7, 6}},
                           {quad4, {3, 0, 4, 7}}});
  const Shape prism =
      first("prism6", 3, prism6, 6,
            {{tri3, {0, 2, 1}}, {tri3, {3, 4, 5}}, {quad4, {0, 1, 4, 3}}, {quad4, {1, 2, 5, 4}}, {quad4, {2, 0, 3, 5}}});

  const std::array<const Shape*, 3> none{};
  const Shape line_3 = second("line3", line, {{0, 1}}, none, {});
  const std::array<const Shape*, 3> edges{&line_3, nullptr, nullptr};
  const std::array<CellType, 3> edge_types{line3, line3, line3};
  const Shape tri_6 = second("tri6", tri, {{0, 1}, {1, 2}, {0, 2}}, edges, edge_types);
  const Middles round{{0, 1}, {1, 2}, {2, 3}, {0, 3}};
  const Shape quad_8 = second("quad8", quad, round, edges, edge_types);
  const auto with = [](Middles middles, const Middles& more) {
    middles.insert(middles.end(), more.begin(), more.end());
    return middles;
  };
  const Shape quad_9 = second("quad9", quad, with(round, {{0, 1, 2, 3}}), edges, edge_types);

  const std::array<const Shape*, 3> serendipity{nullptr, &tri_6, &quad_8}, lagrange{nullptr, &tri_6, &quad_9};
  const std::array<CellType, 3> serendipity_types{line3, tri6, quad8}, lagrange_types{line3, tri6, quad9};
  const Shape tet_10 = second("tet10", tet, {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}}, serendipity, serendipity_types);
  const Middles of_hex{{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  const Middles inside_hex{
      {0, 1, 2, 3}, {0, 1, 4, 5}, {0, 3, 4, 7}, {1, 2, 5, 6}, {2, 3, 6, 7}, {4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}};
  const Middles of_prism{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}};
  const Middles on_prism{{0, 1, 3, 4}, {0, 2, 3, 5}, {1, 2, 4, 5}};
  return {line,
          tri,
          quad,
          tet,
          hex,
          prism,
          line_3,
          tri_6,
          quad_8,
          quad_9,
          tet_10,
          second("hex20", hex, of_hex, serendipity, serendipity_types),
          second("hex27", hex, with(of_hex, inside_hex), lagrange, lagrange_types),
          second("prism15", prism, of_prism, serendipity, serendipity_types),
          second("prism18", prism, with(of_prism, on_prism), lagrange, lagrange_types)};
}

const std::array<Shape, cell_types>& table()
{
  static const auto shapes = make_table();  // in the order of CellType
  return shapes;
}

const Shape& shape(CellType type)
{
  return table()[static_cast<std::size_t>(type)];
}

}  // namespace

int dimension(CellType type)
{
  return shape(type).dimension;
}
int node_count(CellType type)
{
  return shape(type).corners + static_cast<int>(shape(type).middles.size());
}
int corner_count(CellType type)
{
  return shape(type).corners;
}
CellType first_order(CellType type)
{
  return shape(type).first_order;
}
std::string_view name(CellType type)
{
  return shape(type).name;
}
std::optional<CellType> cell_type(std::string_view name)
{
  for (std::size_t t = 0; t < cell_types; ++t)
    if (table()[t].name == name) return static_cast<CellType>(t);
  return {};
}
const std::vector<Face>& faces(CellType type)
{
  return shape(type).faces;
}
const std::vector<std::vector<int>>& middles(CellType type)
{
  return shape(type).middles;
}
int node_amid(CellType type, std::span<const int> corners)
{
  return amid(shape(type), {corners.begin(), corners.end()});
}

}  // namespace mortise::mesh
