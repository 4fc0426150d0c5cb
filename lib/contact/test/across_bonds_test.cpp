// Rows that go on across a bond, against the field that they see.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

// A quarter of four bumps whose tops lie on its cuts, between nodes. All sectors move alike: every row means the jump at its place
// along its normal, those across the cuts and those between nodes as well.
TEST(AcrossBonds, RowsOfASectorMeanTheFieldOfTheWhole)
{
  const Communicator comm;
  const auto square = [](double x) { return x * x; };
  const auto bumps = [&](double x, double y) {
    const auto bump = [&](double s, double t) {
      return square(std::sin(std::numbers::pi * s) * std::cos(std::numbers::pi / 2 * t));
    };
    return Point(x, y, -0.02 * (1 - bump(x, y) - bump(y, x)));
  };
  const auto lid = [](double x, double y) { return Point(x, y, 0.001); };
  auto sector = make_pair(surface({11, 11, 0, 1, 0, 1, true}, bumps, comm),
                          surface({7, 7, -1.4, 1.4, -1.4, 1.4, false, false, primary_ids}, lid, comm), Law::coulomb);
  sector.options.friction = 0.3;
  const std::vector<Pair> pairs{sector, bond_of_quarter(sector.secondary, comm)};
  const auto contacts = discretize(pairs, {}, fem::Kinematics::solid, comm);
  const auto nodes = nodes_of(sector, comm);
  // The same in every sector: u(R x) = R u(x). The lid is at rest.
  const auto field = [](const Point& x) {
    return Point(0.3 * x[0] - 0.2 * x[1], 0.2 * x[0] + 0.3 * x[1], 0.1 + 0.4 * x.head<2>().squaredNorm());
  };
  long long joined = 0, between = 0;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = contacts.nodes[i];
    if (contacts.bonded[i]) continue;
    joined += !node.images.empty();
    if (!node.parts.empty() && !node.images.empty()) {
      ++between;
      double part = 0;
      for (const auto& image : node.images) part += image.part;
      EXPECT_NEAR(part, 0.5, 1e-9);
      EXPECT_NEAR(node.at[0], 0.5, 0.02);
      EXPECT_NEAR(node.at[1], 0, 1e-12);
    }
    // A node's row sees its hat function, which is the field at the node where the faces round it are alike.
    const bool inside = node.at[0] < 0.9 && node.at[1] < 0.9 && node.at.head<2>().norm() > 0.1;
    for (std::size_t r = node.row; inside && r <= node.row + node.tangents.size(); ++r) {
      double seen = 0;
      for (const auto& e : contacts.rows[r])
        if (nodes.contains(e.node) && e.node < primary_ids) seen += e.coefficient * field(nodes.at(e.node))[e.component];
      const Point& axis = r == node.row ? node.normal : node.tangents[r - node.row - 1];
      EXPECT_NEAR(seen, field(node.at).dot(axis), node.parts.empty() ? 1e-7 : 2e-2) << node.at.transpose();
    }
  }
  EXPECT_EQ(comm.sum(joined), 12);
  EXPECT_EQ(comm.sum(between), 1);
}

}  // namespace
}  // namespace mortise::contact
