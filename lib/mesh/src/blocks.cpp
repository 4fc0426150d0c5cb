#include "mesh/blocks.hpp"

#include <map>
#include <vector>

namespace mortise::mesh {

namespace {

// How a grid cell is cut: local nodes of each piece in the grid cell's own numbering (hex8's, or quad4's).
struct Cut {
  CellType type;
  std::vector<std::vector<int>> pieces;
};

const Cut& cut_of(const std::string& element)
{
  using enum CellType;
  static const std::map<std::string, Cut, std::less<>> table{
      {"hex8", {hex8, {{0, 1, 2, 3, 4, 5, 6, 7}}}},
      {"prism6", {prism6, {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}}}},
      {"tet4", {tet4, {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}}},
      {"quad4", {quad4, {{0, 1, 2, 3}}}},
      {"tri3", {tri3, {{0, 1, 2}, {0, 2, 3}}}},
  };
  return table.at(element);
}

const std::pair<const std::string, BlockOptions>& block_at(const Options& options, int block)
{
  return *std::next(options.blocks.begin(), block);
}

// First numbers of the block's nodes and cells.
struct Base {
  Global node = 0, cell = 0;
};

Global nodes_of(const std::array<int, 3>& grid, int dimension)
{
  return Global{grid[0] + 1} * (grid[1] + 1) * (dimension == 3 ? grid[2] + 1 : 1);
}

Base base_of(const Options& options, int dimension, int block)
{
  Base base;
  for (int b = 0; b < block; ++b) {
    const auto grid = grid_of(options, dimension, b);
    base.node += nodes_of(grid, dimension);
    base.cell +=
        Global{grid[0]} * grid[1] * grid[2] * static_cast<Global>(cut_of(block_at(options, b).second.element).pieces.size());
  }
  return base;
}

using Index = std::array<int, 3>;

// Nodes of a grid cell relative to its lowest corner, in hex8's order; the first four are quad4's.
constexpr std::array<Index, 8> corners{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

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
        const int level = side % 2 == 0 ? 0 : grid[axis];
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

Catalogue block_catalogue(const Options& options, int dimension)
{
  Catalogue catalogue;
  catalogue.dimension = dimension;
  for (const auto& [name, block] : options.blocks) {
    const auto grid = grid_of(options, dimension, static_cast<int>(catalogue.bodies.size()));
    catalogue.bodies.push_back({name, name});
    for (int axis = 0; axis < dimension; ++axis)
      for (const char* side : {"min", "max"}) catalogue.boundaries.push_back(name + "." + "xyz"[axis] + side);
    catalogue.node_count += nodes_of(grid, dimension);
    catalogue.cell_count += Global{grid[0]} * grid[1] * grid[2] * static_cast<Global>(cut_of(block.element).pieces.size());
  }
  return catalogue;
}

Mesh generate(const Options& options, int dimension, int block, std::array<int, 3> first, std::array<int, 3> last)
{
  const BlockOptions& box = block_at(options, block).second;
  const Index grid = grid_of(options, dimension, block);
  const Base base = base_of(options, dimension, block);
  const Cut& cut = cut_of(box.element);
  const int planes = dimension == 3 ? last[2] - first[2] + 1 : 1;
  const Index nodes{last[0] - first[0] + 1, last[1] - first[1] + 1, planes};

  Mesh mesh;
  std::vector<Index> place;
  for (int k = first[2]; k < first[2] + nodes[2]; ++k)
    for (int j = first[1]; j < first[1] + nodes[1]; ++j)
      for (int i = first[0]; i < first[0] + nodes[0]; ++i) {
        const Index index{i, j, k};
        Point x = Point::Zero();
        for (int c = 0; c < dimension; ++c) x[c] = options.scale * (box.origin[c] + box.size[c] * index[c] / grid[c]);
        place.push_back(index);
        mesh.points.push_back(x);
        mesh.node_id.push_back(base.node + i + (grid[0] + Global{1}) * (j + (grid[1] + Global{1}) * k));
      }
  const auto node = [&](int i, int j, int k) { return (i - first[0]) + nodes[0] * ((j - first[1]) + nodes[1] * (k - first[2])); };
  for (int k = first[2]; k < last[2]; ++k)
    for (int j = first[1]; j < last[1]; ++j)
      for (int i = first[0]; i < last[0]; ++i)
        for (std::size_t p = 0; p < cut.pieces.size(); ++p) {
          std::vector<Local> cell;
          for (const int corner : cut.pieces[p]) {
            const auto& at = corners[static_cast<std::size_t>(corner)];
            cell.push_back(node(i + at[0], j + at[1], k + at[2]));
          }
          mesh.cells.add(cut.type, cell);
          mesh.cell_id.push_back(base.cell +
                                 (i + Global{grid[0]} * (j + Global{grid[1]} * k)) * static_cast<Global>(cut.pieces.size()) +
                                 static_cast<Global>(p));
          mesh.cell_body.push_back(block);
        }
  add_facets(mesh, place, grid, dimension, block);
  return mesh;
}

}  // namespace mortise::mesh
