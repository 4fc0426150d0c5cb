#include "mesh/cell.hpp"

#include <array>

namespace mortise::mesh {

namespace {

// To add a cell: a row here, its name in CellType, and its element in fem.
struct Shape {
  std::string_view name;
  int dimension;
  int nodes;
  std::vector<Face> faces;
};

const Shape& shape(CellType type)
{
  using enum CellType;
  static const std::array<Shape, 6> table{{
      {"line2", 1, 2, {}},
      {"tri3", 2, 3, {{line2, {0, 1}}, {line2, {1, 2}}, {line2, {2, 0}}}},
      {"quad4", 2, 4, {{line2, {0, 1}}, {line2, {1, 2}}, {line2, {2, 3}}, {line2, {3, 0}}}},
      {"tet4", 3, 4, {{tri3, {0, 2, 1}}, {tri3, {0, 1, 3}}, {tri3, {1, 2, 3}}, {tri3, {0, 3, 2}}}},
      {"hex8",
       3,
       8,
       {{quad4, {0, 3, 2, 1}},
        {quad4, {4, 5, 6, 7}},
        {quad4, {0, 1, 5, 4}},
        {quad4, {1, 2, 6, 5}},
        {quad4, {2, 3, 7, 6}},
        {quad4, {3, 0, 4, 7}}}},
      {"prism6",
       3,
       6,
       {{tri3, {0, 2, 1}}, {tri3, {3, 4, 5}}, {quad4, {0, 1, 4, 3}}, {quad4, {1, 2, 5, 4}}, {quad4, {2, 0, 3, 5}}}},
  }};
  return table[static_cast<std::size_t>(type)];
}

}  // namespace

int dimension(CellType type)
{
  return shape(type).dimension;
}
int node_count(CellType type)
{
  return shape(type).nodes;
}
std::string_view name(CellType type)
{
  return shape(type).name;
}
const std::vector<Face>& faces(CellType type)
{
  return shape(type).faces;
}

}  // namespace mortise::mesh
