#include "mesh/blocks.hpp"

#include <map>
#include <vector>

namespace mortise::mesh {

namespace {

// How a grid cell is cut: corners of each piece in the grid cell's own numbering (hex8's, or quad4's).
const std::vector<std::vector<int>>& pieces_of(CellType type)
{
  using enum CellType;
  static const std::map<CellType, std::vector<std::vector<int>>> table{
      {hex8, {{0, 1, 2, 3, 4, 5, 6, 7}}},
      {prism6, {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}}},
      {tet4, {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}},
      {quad4, {{0, 1, 2, 3}}},
      {tri3, {{0, 1, 2}, {0, 2, 3}}},
  };
  return table.at(first_order(type));
}

CellType type_of(const BlockOptions& block)
{
  return cell_type(block.element).value();
}

const std::pair<const std::string, BlockOptions>& block_at(const Options& options, int block)
{
  return *std::next(options.blocks.begin(), block);
}

using Index = std::array<int, 3>;

// Nodes stand on a grid twice as fine as that of the cells. They are numbered by which of their places are odd: first the
// corners, then the middles of edges along x, along y, of faces across z, .. as far as the cells have such nodes.
class NodeNumbers {
 public:
  NodeNumbers(CellType type, const Index& grid, int dimension)
  {
    const bool second = type != first_order(type), serendipity = type == CellType::hex20 || type == CellType::quad8;
    for (int odd = 0; odd < (second ? 1 << dimension : 1); ++odd) {
      const int directions = (odd & 1) + (odd >> 1 & 1) + (odd >> 2);
      if (serendipity && directions > 1) continue;
      if (type == CellType::prism15 && odd > 4) continue;  // no middles of the quadrilaterals
      Class nodes{{odd & 1, odd >> 1 & 1, odd >> 2}, {1, 1, 1}, count_};
      for (int c = 0; c < dimension; ++c) {
        const auto axis = static_cast<std::size_t>(c);
        nodes.size[axis] = grid[axis] + 1 - nodes.odd[axis];
      }
      count_ += Global{nodes.size[0]} * nodes.size[1] * nodes.size[2];
      classes_.push_back(nodes);
    }
  }

  struct Class {
    Index odd;   // 0 or 1 an axis
    Index size;  // nodes along each axis
    Global first;
    Global number(const Index& at) const { return first + at[0] + Global{size[0]} * (at[1] + Global{size[1]} * at[2]); }
  };
  const std::vector<Class>& classes() const { return classes_; }
  Global count() const { return count_; }

  // Of the node at a place of the fine grid.
  Global operator()(const Index& place) const
  {
    for (const auto& c : classes_)
      if ((place[0] & 1) == c.odd[0] && (place[1] & 1) == c.odd[1] && (place[2] & 1) == c.odd[2])
        return c.number({place[0] / 2, place[1] / 2, place[2] / 2});
    return -1;
  }

 private:
  std::vector<Class> classes_;
  Global count_ = 0;
};

Global cells_of(const Index& grid, CellType type)
{
  return Global{grid[0]} * grid[1] * grid[2] * static_cast<Global>(pieces_of(type).size());
}

// Nodes of a grid cell relative to its lowest corner, in hex8's order; the first four are quad4's.
constexpr std::array<Index, 8> hex_corners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

// Places of a piece's nodes in the fine grid, from the lowest corner of the grid cell.
std::vector<Index> places_of(CellType type, const std::vector<int>& piece)
{
  std::vector<Index> places;
  for (const int corner : piece) {
    const auto& at = hex_corners[static_cast<std::size_t>(corner)];
    places.push_back({2 * at[0], 2 * at[1], 2 * at[2]});
  }
  for (const auto& amid : middles(type)) {
    Index sum{0, 0, 0};
    for (const int c : amid)
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += places[static_cast<std::size_t>(c)][axis];
    for (auto& x : sum) x /= static_cast<int>(amid.size());
    places.push_back(sum);
  }
  return places;
}

// Facets on the sides of the block, of cells that touch them.
void add_facets(Mesh& mesh, const std::vector<Index>& place, const Index& grid, int dimension, int block)
{
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    for (const auto& face : faces(mesh.cells.type[c])) {
      std::vector<Local> on;
      for (const int i : face.nodes) on.push_back(nodes[static_cast<std::size_t>(i)]);
      for (int side = 0; side < 2 * dimension; ++side) {
        const auto axis = static_cast<std::size_t>(side / 2);
        const int level = side % 2 == 0 ? 0 : 2 * grid[axis];
        bool all = true;
        for (const Local n : on) all = all && place[static_cast<std::size_t>(n)][axis] == level;
        if (!all) continue;
        mesh.facets.cells.add(face.type, on);
        mesh.facets.parent.push_back(static_cast<Local>(c));
        mesh.facets.boundary.push_back(block * 2 * dimension + side);
      }
    }
  }
}

}  // namespace

std::array<int, 3> grid_of(const Options& options, int dimension, int block)
{
  auto grid = block_at(options, block).second.cells;
  if (dimension == 2) grid[2] = 1;
  return grid;
}

First first_numbers(const Options& options, int dimension, int block)
{
  First base;
  for (int b = 0; b < block; ++b) {
    const auto grid = grid_of(options, dimension, b);
    const auto type = type_of(block_at(options, b).second);
    base.node += NodeNumbers(type, grid, dimension).count();
    base.cell += cells_of(grid, type);
  }
  return base;
}

Catalogue block_catalogue(const Options& options, int dimension)
{
  Catalogue catalogue;
  catalogue.dimension = dimension;
  for (const auto& [name, block] : options.blocks) {
    const auto grid = grid_of(options, dimension, static_cast<int>(catalogue.bodies.size()));
    catalogue.bodies.push_back({name, name});
    catalogue.volumes.push_back(name);
    for (int axis = 0; axis < dimension; ++axis)
      for (const char* side : {"min", "max"}) catalogue.boundaries.push_back(name + "." + "xyz"[axis] + side);
    catalogue.node_count += NodeNumbers(type_of(block), grid, dimension).count();
    catalogue.cell_count += cells_of(grid, type_of(block));
  }
  return catalogue;
}

Mesh generate(const Options& options, int dimension, int block, std::array<int, 3> first, std::array<int, 3> last)
{
  const BlockOptions& box = block_at(options, block).second;
  const Index grid = grid_of(options, dimension, block);
  const First base = first_numbers(options, dimension, block);
  const CellType type = type_of(box);
  const NodeNumbers whole(type, grid, dimension);
  const NodeNumbers own(type, {last[0] - first[0], last[1] - first[1], last[2] - first[2]}, dimension);

  Mesh mesh;
  std::vector<Index> place;  // of each node in the fine grid of the block
  for (std::size_t c = 0; c < own.classes().size(); ++c) {
    const auto& nodes = own.classes()[c];
    for (int k = 0; k < nodes.size[2]; ++k)
      for (int j = 0; j < nodes.size[1]; ++j)
        for (int i = 0; i < nodes.size[0]; ++i) {
          const Index cell{first[0] + i, first[1] + j, first[2] + k};
          Index at{};
          Point x = Point::Zero();
          for (std::size_t a = 0; a < 3; ++a) at[a] = 2 * cell[a] + nodes.odd[a];
          for (int a = 0; a < dimension; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            x[a] = options.scale * (box.origin[axis] + box.size[axis] * at[axis] / (2 * grid[axis]));
          }
          place.push_back(at);
          mesh.points.push_back(x);
          mesh.node_id.push_back(base.node + whole.classes()[c].number(cell));
        }
  }
  std::vector<std::vector<Index>> pieces;
  for (const auto& piece : pieces_of(type)) pieces.push_back(places_of(type, piece));
  for (int k = first[2]; k < last[2]; ++k)
    for (int j = first[1]; j < last[1]; ++j)
      for (int i = first[0]; i < last[0]; ++i)
        for (std::size_t p = 0; p < pieces.size(); ++p) {
          std::vector<Local> cell;
          for (const auto& at : pieces[p])
            cell.push_back(
                static_cast<Local>(own({2 * (i - first[0]) + at[0], 2 * (j - first[1]) + at[1], 2 * (k - first[2]) + at[2]})));
          mesh.cells.add(type, cell);
          mesh.cell_id.push_back(base.cell +
                                 (i + Global{grid[0]} * (j + Global{grid[1]} * k)) * static_cast<Global>(pieces.size()) +
                                 static_cast<Global>(p));
          mesh.cell_body.push_back(block);
        }
  add_facets(mesh, place, grid, dimension, block);
  return mesh;
}

}  // namespace mortise::mesh
