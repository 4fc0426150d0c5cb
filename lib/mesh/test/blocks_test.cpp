#include "mesh/blocks.hpp"

#include <gtest/gtest.h>

#include <set>

#include "mesh/topology.hpp"

namespace mortise::mesh {
namespace {

Options one_block(const std::string& element, std::array<int, 3> cells)
{
  Options options;
  BlockOptions block;
  block.origin = {1, 2, 3};
  block.size = {2, 3, 4};
  block.cells = cells;
  block.element = element;
  options.blocks["box"] = block;
  return options;
}

// Area vector of a facet.
Point area(const Mesh& mesh, std::size_t f)
{
  const auto n = mesh.facets.cells[f];
  const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(n[i])]; };
  const int corners = corner_count(mesh.facets.cells.type[f]);
  if (corners == 2) return Point(p(1)[1] - p(0)[1], p(0)[0] - p(1)[0], 0);
  if (corners == 3) return 0.5 * (p(1) - p(0)).cross(p(2) - p(0));
  return 0.5 * (p(2) - p(0)).cross(p(3) - p(1));
}

class Blocks : public testing::TestWithParam<std::tuple<std::string, int, int>> {};

TEST_P(Blocks, HaveTheirCellsAndOutwardFacetsOnAllSides)
{
  const auto& [element, dimension, pieces] = GetParam();
  const auto options = one_block(element, {2, 3, dimension == 3 ? 4 : 0});
  const auto catalogue = block_catalogue(options, dimension);
  const auto mesh = generate(options, dimension, 0, {0, 0, 0}, grid_of(options, dimension, 0));
  EXPECT_EQ(static_cast<int>(mesh.cells.size()), pieces * 6 * (dimension == 3 ? 4 : 1));
  EXPECT_EQ(static_cast<Global>(mesh.cells.size()), catalogue.cell_count);
  EXPECT_EQ(static_cast<Global>(mesh.node_count()), catalogue.node_count);
  ASSERT_EQ(static_cast<int>(catalogue.boundaries.size()), 2 * dimension);
  EXPECT_EQ(catalogue.boundaries[1], "box.xmax");
  for (int side = 0; side < 2 * dimension; ++side) {
    Point sum = Point::Zero();
    for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f)
      if (mesh.facets.boundary[f] == side) sum += area(mesh, f);
    const double sizes[3] = {2, 3, dimension == 3 ? 4.0 : 1.0};
    Point expected = Point::Zero();
    expected[side / 2] = (side % 2 == 0 ? -1 : 1) * sizes[0] * sizes[1] * sizes[2] / sizes[side / 2];
    EXPECT_LT((sum - expected).norm(), 1e-12) << "side " << side;
  }
  // Every node of a cell after the corners lies amid its corners, and every node belongs to a cell.
  std::set<Local> used;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto type = mesh.cells.type[c];
    const auto nodes = mesh.cells[c];
    used.insert(nodes.begin(), nodes.end());
    for (std::size_t m = 0; m < middles(type).size(); ++m) {
      Point sum = Point::Zero();
      for (const int k : middles(type)[m]) sum += mesh.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])];
      const auto node = nodes[static_cast<std::size_t>(corner_count(type)) + m];
      EXPECT_LT((mesh.points[static_cast<std::size_t>(node)] - sum / static_cast<double>(middles(type)[m].size())).norm(), 1e-14);
    }
  }
  EXPECT_EQ(used.size(), mesh.node_count());
  // One connected body.
  const auto parts = connected_parts(face_neighbours(mesh.cells), std::vector<int>(mesh.cells.size(), 0));
  EXPECT_EQ(*std::max_element(parts.begin(), parts.end()), 0);
}

INSTANTIATE_TEST_SUITE_P(Elements, Blocks,
                         testing::Values(std::tuple("hex8", 3, 1), std::tuple("tet4", 3, 6), std::tuple("prism6", 3, 2),
                                         std::tuple("quad4", 2, 1), std::tuple("tri3", 2, 2), std::tuple("hex20", 3, 1),
                                         std::tuple("hex27", 3, 1), std::tuple("tet10", 3, 6), std::tuple("prism15", 3, 2),
                                         std::tuple("prism18", 3, 2), std::tuple("quad8", 2, 1), std::tuple("quad9", 2, 1),
                                         std::tuple("tri6", 2, 2)));

class Pieces : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Elements, Pieces, testing::Values("tet4", "hex20", "hex27", "tet10", "prism15", "prism18"));

TEST_P(Pieces, AgreeWithTheWholeToTheLastBit)
{
  const auto options = one_block(GetParam(), {4, 3, 5});
  const auto whole = generate(options, 3, 0, {0, 0, 0}, {4, 3, 5});
  const auto piece = generate(options, 3, 0, {1, 0, 2}, {3, 3, 5});
  for (std::size_t n = 0; n < piece.node_count(); ++n)
    EXPECT_EQ(piece.points[n], whole.points[static_cast<std::size_t>(piece.node_id[n])]);
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    const auto in_whole = whole.cells[static_cast<std::size_t>(piece.cell_id[c])];
    for (std::size_t i = 0; i < in_whole.size(); ++i)
      EXPECT_EQ(piece.node_id[static_cast<std::size_t>(piece.cells[c][i])], in_whole[i]);
  }
  EXPECT_TRUE(std::is_sorted(piece.node_id.begin(), piece.node_id.end()));
}

TEST(Topology, SubmeshKeepsItsFacets)
{
  const auto options = one_block("hex8", {2, 2, 2});
  const auto mesh = generate(options, 3, 0, {0, 0, 0}, {2, 2, 2});
  const auto part = Submeshes(mesh)(std::vector<Local>{0, 3});
  EXPECT_EQ(part.cells.size(), 2U);
  EXPECT_EQ(part.facets.cells.size(), 6U);  // two corner cells with three outer faces each
  EXPECT_EQ(part.node_count(), 14U);        // they share an edge
  EXPECT_EQ(part.cell_id[1], 3);
}

}  // namespace
}  // namespace mortise::mesh
