#include "partition/interface_elimination.hpp"

#include <gtest/gtest.h>

#include "partition/decompose.hpp"
#include "testing/cut.hpp"

namespace mortise::partition {
namespace {

std::vector<FactorSize> of_grids(std::array<int, 3> cells, std::array<int, 3> lower, std::array<int, 3> upper,
                                 const Communicator& comm)
{
  Options options;
  options.method = "grid";
  options.counts = {{"lower", {lower[0], lower[1], lower[2]}}, {"upper", {upper[0], upper[1], upper[2]}}};
  const auto d = cut_of(two_blocks("hex8", cells, cells), options, comm);
  std::vector<std::vector<double>> weight;
  for (const auto& s : d.subdomains) weight.emplace_back(s.mesh.node_count(), 1.0);
  const NodeDirectory directory(d, weight, comm);
  return interface_elimination(d, find_interface(d, directory, comm), comm);
}

// A dense lower triangle: n (n + 1) / 2 entries, 1 + 4 + .. + n^2 multiplications.
void expect_triangle(const FactorSize& size, double n)
{
  EXPECT_DOUBLE_EQ(size.entries, n * (n + 1) / 2);
  EXPECT_DOUBLE_EQ(size.operations, n * (n + 1) * (2 * n + 1) / 6);
}

TEST(InterfaceElimination, TwoSubdomainsShareADenseTriangle)
{
  const Communicator comm;
  const auto sizes = of_grids({8, 3, 4}, {2, 1, 1}, {1, 1, 1}, comm);
  ASSERT_EQ(sizes.size(), 2u);
  expect_triangle(sizes[0], 3 * 4 * 5);
  expect_triangle(sizes[1], 0);
}

TEST(InterfaceElimination, GroupsOfFourSubdomainsTakeNoOrderThatHelps)
{
  const Communicator comm;
  // Each of the four faces meets two others and the edge: whatever the order, all but two opposite faces are dense.
  const auto sizes = of_grids({4, 4, 2}, {2, 2, 1}, {2, 1, 1}, comm);
  const double face = 3 * 2 * 3, edge = 3 * 3, left = 2 * face + edge;
  EXPECT_DOUBLE_EQ(sizes[0].entries, 2 * (face * (face + 1) / 2 + face * (2 * face + edge)) + left * (left + 1) / 2);
}

TEST(InterfaceElimination, AChainGrowsLikeItsLength)
{
  const Communicator comm;
  const auto sizes = of_grids({64, 2, 2}, {16, 1, 1}, {32, 1, 1}, comm);
  const double n = 27;  // unknowns of a face; each but the ends is eliminated with one or two others left
  for (std::size_t b : {0u, 1u}) {
    const double faces = b == 0 ? 15 : 31;
    EXPECT_GT(sizes[b].entries, faces * n * n);
    EXPECT_LT(sizes[b].entries, faces * 2.5 * n * n);
    EXPECT_LT(sizes[b].operations, faces * 8 * n * n * n);
  }
}

}  // namespace
}  // namespace mortise::partition
