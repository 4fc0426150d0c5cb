// contact.pvd as a piece, and pressures on both sides of a contact.
#include <gtest/gtest.h>

#include "deck_of_blocks.hpp"
#include "output/contact_pressure.hpp"
#include "output/contact_sides.hpp"

namespace mortise::output {
namespace {

// Nodes up to x = 1 are near: of three columns of faces two are shown, and the far nodes of these have the gap of the others.
TEST(ContactSides, ShowFacesThatAreNear)
{
  const DeckOfBlocks blocks("");
  const auto pair = blocks.joint();
  const auto& side = pair.secondary;
  auto state = DeckOfBlocks::no_state(side);
  for (std::size_t n = 0; n < side.points.size(); ++n) {
    const double x = side.points[n][0];
    state.near[n] = x < 1;
    state.gap[n] = state.near[n] ? x : 0;
    state.slip[n] = state.near[n] ? side.points[n] : Point(Point::Zero());
    state.status[n] = state.near[n];
  }
  const auto piece = contact_sides(std::vector{pair}, std::vector{state});
  EXPECT_EQ(blocks.comm.sum(static_cast<long long>(piece.cells.size())), 4);
  for (std::size_t p = 0; p < piece.points.size(); ++p) {
    const auto& x = piece.points[p];
    EXPECT_LT(x[0], 1.2);
    EXPECT_NEAR(at(piece.point_fields, "gap", p)[0], std::min(x[0], 0.5 + 1.0 / 3), 1e-12);
    EXPECT_EQ(at(piece.point_fields, "slip", p), Eigen::VectorXd(x[0] < 1 ? x : Point(Point::Zero())));
    EXPECT_EQ(at(piece.point_fields, "contact_status", p)[0], x[0] < 1 ? 1 : 0);
  }
  ASSERT_EQ(piece.words.size(), 2U);
  EXPECT_EQ(piece.words[1].second, (std::vector<std::string>{"0: joint"}));
}

TEST(ContactSides, OfSeveralContactsCarryTheirNumbers)
{
  const DeckOfBlocks blocks("");
  const std::vector pairs{blocks.joint(), blocks.joint()};
  auto first = DeckOfBlocks::no_state(pairs[0].secondary), second = first;
  std::fill(second.pressure.begin(), second.pressure.end(), 3.0);
  const auto piece = contact_sides(pairs, std::vector{first, second});
  for (std::size_t c = 0; c < piece.cells.size(); ++c)
    for (const Local p : piece.cells[c])
      EXPECT_EQ(at(piece.point_fields, "contact_pressure", static_cast<std::size_t>(p))[0],
                3 * at(piece.cell_fields, "contact", c)[0]);
  EXPECT_EQ(piece.cells.size(), 2 * pairs[0].secondary.faces.size());
}

// 1 + x on the upper block's face; its cells do not match those below, which reach out on both sides.
TEST(ContactPressure, StandsOnBothSides)
{
  const DeckOfBlocks blocks("");
  const auto pair = blocks.joint();
  auto state = DeckOfBlocks::no_state(pair.secondary);
  for (std::size_t n = 0; n < pair.secondary.points.size(); ++n) state.recovered_pressure[n] = 1 + pair.secondary.points[n][0];
  const auto pressure =
      contact_pressure(blocks.decomposition, blocks.interface, std::vector{pair}, std::vector{state}, blocks.comm);
  for (std::size_t s = 0; s < blocks.decomposition.subdomains.size(); ++s) {
    const auto& mesh = blocks.decomposition.subdomains[s].mesh;
    for (std::size_t n = 0; n < mesh.node_count(); ++n) {
      const Point& x = mesh.points[n];
      const bool pressed = x[2] == 1 && std::abs(x[0] - 1) < 0.51;
      EXPECT_NEAR(pressure[s](static_cast<Eigen::Index>(n), 0), pressed ? 1 + x[0] : 0, 1e-9) << x.transpose();
    }
  }
}

// A node of two secondary sides has the larger pressure; what does not press leaves the other side at zero.
TEST(ContactPressure, IsTheLargestOfSeveralContacts)
{
  const DeckOfBlocks blocks("");
  const std::vector pairs{blocks.joint(), blocks.joint()};
  auto small = DeckOfBlocks::no_state(pairs[0].secondary), large = small;
  std::fill(small.recovered_pressure.begin(), small.recovered_pressure.end(), 2.0);
  std::fill(large.recovered_pressure.begin(), large.recovered_pressure.end(), 5.0);
  const auto largest = [&](const std::vector<contact::SurfaceState>& states) {
    double found = 0;
    for (const auto& values : contact_pressure(blocks.decomposition, blocks.interface, pairs, states, blocks.comm))
      found = std::max(found, values.maxCoeff());
    return blocks.comm.max(found);
  };
  EXPECT_NEAR(largest({large, small}), 5, 1e-12);
  EXPECT_NEAR(largest({small, large}), 5, 1e-12);
  const auto none = DeckOfBlocks::no_state(pairs[0].secondary);
  EXPECT_EQ(largest({none, none}), 0);
}

}  // namespace
}  // namespace mortise::output
