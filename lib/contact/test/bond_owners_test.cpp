#include "rows/bond_owners.hpp"

#include <gtest/gtest.h>

namespace mortise::contact {
namespace {

Communicator self()
{
  return Communicator(MPI_COMM_SELF);
}

// Node 3 of one body lies opposite nodes 10, 11 of a second one and 20, 21 of a third one.
std::vector<CoveredNode> node_on_two(double first, double second, bool match = false)
{
  return {{3, 0, match, first, {10, 11, -1, -1}}, {3, 1, match, second, {20, 21, -1, -1}}};
}

const std::vector<NodeOfBond> untied{{3, 0}, {3, 1}, {10, 0}, {11, 0}, {20, 1}, {21, 1}};
const std::vector<NodeOfBond> tied{{3, 0}, {3, 1}, {10, 0}, {10, 2}, {11, 0}, {20, 1}, {20, 2}, {21, 1}};
const std::vector<NodeOfBond> tied_to_a_third{{3, 0},  {3, 1},  {10, 0}, {10, 2}, {11, 0},
                                              {20, 1}, {21, 1}, {21, 3}, {30, 2}, {30, 3}};

TEST(BondOwners, BodiesThatNothingElseTiesKeepBothBonds)
{
  EXPECT_TRUE(nodes_of_others(node_on_two(1, 1), untied, self()).empty());
}

TEST(BondOwners, TiedToEachOtherOrToAThirdBody)
{
  for (const auto& sides : {tied, tied_to_a_third}) {
    const auto found = nodes_of_others(node_on_two(0.5, 0.5 + 1e-9), sides, self());
    ASSERT_EQ(found.size(), 1U);  // the first of two that cover as much keeps it
    EXPECT_EQ(found[0].node, 3);
    EXPECT_EQ(found[0].bond, 1);
    const auto other = nodes_of_others(node_on_two(0.3, 0.7), sides, self());
    ASSERT_EQ(other.size(), 1U);
    EXPECT_EQ(other[0].bond, 0);
  }
}

TEST(BondOwners, MatchingFacesKeepPairs)
{
  EXPECT_TRUE(nodes_of_others(node_on_two(1, 1, true), tied, self()).empty());
}

TEST(BondOwners, OneBodyOnBothSidesOfAnEdge)
{
  const std::vector<NodeOfBond> sides{{3, 0}, {3, 1}, {10, 0}, {11, 0}, {11, 1}, {12, 1}};
  const std::vector<CoveredNode> nodes{{3, 0, false, 1, {10, 11, -1, -1}}, {3, 1, false, 1, {11, 12, -1, -1}}};
  EXPECT_EQ(nodes_of_others(nodes, sides, self()).size(), 1U);
}

// Node 4 has nothing opposite in the second bond; that it is tied to the first one is known from node 3.
TEST(BondOwners, PastTheBorderOfABondThatIsTied)
{
  auto nodes = node_on_two(1, 1);
  nodes.push_back({4, 0, false, 1.0, {11, 10, -1, -1}});
  nodes.push_back({4, 1, false, 0.2});
  const auto with_node_4 = [](std::vector<NodeOfBond> sides) {
    sides.insert(sides.begin() + 2, {{4, 0}, {4, 1}});
    return sides;
  };
  const auto found = nodes_of_others(nodes, with_node_4(tied), self());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].node, 4);
  EXPECT_EQ(found[1].bond, 1);
  EXPECT_TRUE(nodes_of_others(nodes, with_node_4(untied), self()).empty());
}

// Node 10 of the second body lies opposite 20 of the third one, and is met by node 3 of the first one, whose bond to the third
// one has other nodes beside it.
TEST(BondOwners, TheLastOfARingGivesWay)
{
  const std::vector<NodeOfBond> sides{{3, 0}, {3, 1}, {10, 0}, {10, 2}, {20, 1}, {20, 2}};
  const std::vector<CoveredNode> nodes{
      {3, 0, false, 1, {10, 11, -1, -1}}, {10, 2, false, 1, {20, 21, -1, -1}}, {20, 1, false, 1, {3, 4, -1, -1}}};
  const auto found = nodes_of_others(nodes, sides, self());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].node, 10);
  EXPECT_EQ(found[0].bond, 2);
  auto matching = nodes;
  for (auto& node : matching) node.matches = true;
  EXPECT_TRUE(nodes_of_others(matching, sides, self()).empty());
  matching[2].matches = false;  // the one that does not match gives way
  const auto other = nodes_of_others(matching, sides, self());
  ASSERT_EQ(other.size(), 1U);
  EXPECT_EQ(other[0].node, 20);
}

// Pairs of nodes agree with each other, but not with those that a preload draws together.
TEST(BondOwners, APreloadGivesWayWhereFacesMatch)
{
  auto nodes = node_on_two(1, 1, true);
  nodes[0].preloaded = true;
  const auto found = nodes_of_others(nodes, tied, self());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].bond, 0);
  EXPECT_TRUE(nodes_of_others(nodes, untied, self()).empty());

  const std::vector<NodeOfBond> sides{{3, 0}, {3, 1}, {10, 0}, {10, 2}, {20, 1}, {20, 2}};
  std::vector<CoveredNode> ring{
      {3, 0, true, 1, {10, -1, -1, -1}}, {10, 2, true, 1, {20, -1, -1, -1}}, {20, 1, true, 1, {3, -1, -1, -1}}};
  ring[0].preloaded = true;
  const auto last = nodes_of_others(ring, sides, self());
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(last[0].node, 3);
  EXPECT_EQ(last[0].bond, 0);
}

// A sector of two rings, 1 to 10 by bond 0, with cuts of their own, bonds 1 and 2: from node 1 on the way leads to node 2 of the
// next sector, there by bond 0 to node 20, and by the other cut back to node 10.
TEST(BondOwners, RoundASectorTheBondOfTwoRingsClosesTheRing)
{
  const std::vector<NodeOfBond> sides{{1, 0}, {1, 1}, {2, 0}, {2, 1}, {10, 0}, {10, 2}, {20, 0}, {20, 2}};
  std::vector<CoveredNode> nodes{{1, 0, false, 0.5, {10, 11, -1, -1}},
                                 {1, 1, true, 0.5, {2, 3, -1, -1}, true},
                                 {2, 0, false, 0.5, {20, 21, -1, -1}},
                                 {10, 2, true, 0.5, {20, 22, -1, -1}, true}};
  const auto found = nodes_of_others(nodes, sides, self());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].node, 1);
  EXPECT_EQ(found[0].bond, 0);
  nodes.pop_back();  // the second ring is not tied to the next sector
  auto open = sides;
  std::erase_if(open, [](const NodeOfBond& side) { return side.bond == 2; });
  EXPECT_TRUE(nodes_of_others(nodes, open, self()).empty());
}

}  // namespace
}  // namespace mortise::contact
