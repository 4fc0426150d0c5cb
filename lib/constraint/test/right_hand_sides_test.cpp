#include "constraint/right_hand_sides.hpp"

#include <gtest/gtest.h>

#include "constraint/supports.hpp"
#include "nodes.hpp"

namespace mortise::constraint {
namespace {

// A point on every rank: a normal row with a prescribed entry of coefficient -0.5 along x, and one tangential row.
Contacts one_point()
{
  Contacts contacts;
  contacts.nodes.push_back({0, 7, 1.0, Point(1, 0, 0), {Point(0, 1, 0)}, 0, 1.0, 0.25, Point::Zero()});
  contacts.bonded.push_back(false);
  contacts.rows.entries = {{7, 0, 1.0}};
  contacts.rows.close(0.25 + 0.5 * 0.1);
  contacts.rows.entries.push_back({7, 1, 1.0});
  contacts.rows.close(0);
  contacts.prescribed = {{0, 0, 0, -0.5}};
  return contacts;
}

std::vector<Support> support(std::optional<double> x)
{
  return {{"wall", {x, std::nullopt, std::nullopt}}};
}

TEST(RightHandSides, SupportsThatMoveShiftBounds)
{
  const Communicator comm;
  const auto nodes = anywhere({{0, 1, 2, 3}});
  Constraints constraints{dirichlet_rows(support(0.1), nodes, 3, comm), one_point()};
  EXPECT_TRUE(update_rhs(constraints, dirichlet_rows(support(0.3), nodes, 3, comm), support(0.3), support(0.1), comm));
  EXPECT_NEAR(constraints.contacts.rows.bound[0], 0.25 + 0.5 * 0.3, 1e-15);
  for (const auto& prescribed : constraints.prescribed) EXPECT_EQ(prescribed.value, 0.3);
}

TEST(RightHandSides, OtherPrescribedComponentsAreOtherRows)
{
  const Communicator comm;
  const auto nodes = anywhere({{0, 1, 2, 3}});
  Constraints constraints{dirichlet_rows(support(0.1), nodes, 3, comm), one_point()};
  EXPECT_FALSE(
      update_rhs(constraints, dirichlet_rows(support(std::nullopt), nodes, 3, comm), support(std::nullopt), support(0.1), comm));
  EXPECT_NEAR(constraints.contacts.rows.bound[0], 0.25 + 0.5 * 0.1, 1e-15);
  EXPECT_EQ(comm.sum(static_cast<long long>(constraints.prescribed.size())), 4);
}

// Their motion differs from node to node.
TEST(RightHandSides, CouplingsThatMoveWhatContactsMeetAskForOtherRows)
{
  const Communicator comm;
  const auto nodes = anywhere({{0, 1, 2, 3}});
  Constraints constraints{dirichlet_rows(support(0.1), nodes, 3, comm), one_point()};
  constraints.contacts.prescribed[0].coupling = 0;
  constraints.contacts.prescribed[0].support = 1;
  for (auto& prescribed : constraints.prescribed) prescribed.coupling = 0;
  auto same = constraints.prescribed, moved = same;
  for (auto& prescribed : moved) prescribed.value = 0.3;
  EXPECT_FALSE(update_rhs(constraints, std::move(moved), support(0.1), support(0.1), comm));
  EXPECT_TRUE(update_rhs(constraints, std::move(same), support(0.1), support(0.1), comm));
  EXPECT_NEAR(constraints.contacts.rows.bound[0], 0.25 + 0.5 * 0.1, 1e-15);
}

TEST(RightHandSides, InterferenceClosesGaps)
{
  auto contacts = one_point();
  contacts.nodes[0].weight = 2;
  add_interference(contacts, 1, 0.1);
  EXPECT_EQ(contacts.nodes[0].gap, 0.25);
  add_interference(contacts, 0, 0.1);
  EXPECT_NEAR(contacts.nodes[0].gap, 0.05, 1e-15);
  EXPECT_NEAR(contacts.rows.bound[0], 0.3 - 0.2, 1e-15);
  contacts.nodes[0].prescribed_share = 0.25;  // of what overlaps
  add_interference(contacts, 0, 0.1);
  EXPECT_NEAR(contacts.nodes[0].gap, -0.15, 1e-15);
  EXPECT_NEAR(contacts.rows.bound[0], 0.3 - 0.2 - 0.05 - 0.75 * 0.15, 1e-15);
  add_interference(contacts, 0, -0.2);
  EXPECT_NEAR(contacts.rows.bound[0], 0.3, 1e-15);
}

TEST(RightHandSides, SlipCountsFromTheStepBefore)
{
  auto contacts = one_point();
  contacts.rows.bound[1] = 0.5;  // what a moving support contributes
  EXPECT_EQ(contacts.slipped_before(1), 0);
  remember_slip(contacts, std::vector<double>{9.0, 0.7});
  EXPECT_NEAR(contacts.slipped_before(1), 0.2, 1e-15);
  EXPECT_NEAR(contacts.rows.bound[1], 0.7, 1e-15);
  EXPECT_EQ(contacts.rows.bound[0], 0.25 + 0.5 * 0.1);
  remember_slip(contacts, std::vector<double>{9.0, 0.6});
  EXPECT_NEAR(contacts.slipped_before(1), 0.1, 1e-15);
}

TEST(RightHandSides, BondedNodesStayTied)
{
  auto contacts = one_point();
  contacts.bonded[0] = true;
  remember_slip(contacts, std::vector<double>{0.3, 0.7});
  EXPECT_EQ(contacts.slipped_before(1), 0);
  EXPECT_EQ(contacts.rows.bound[1], 0);
}

}  // namespace
}  // namespace mortise::constraint
