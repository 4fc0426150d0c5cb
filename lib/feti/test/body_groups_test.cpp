// Which bodies feel each other: blocks on each other, beside others that nothing ties to them.
#include "feti/body_groups.hpp"

#include <gtest/gtest.h>

#include "testing/blocks.hpp"

namespace mortise::feti {
namespace {

mesh::BlockOptions cube(double x, double z)
{
  return {{x, 0, z}, {1, 1, 1}, {2, 2, 2}, "hex8"};
}

BodyGroups groups_of(const Blocks& blocks)
{
  const JumpOperator jump(blocks.decomposition, *blocks.directory, blocks.interface, blocks.constraints.prescribed, {},
                          blocks.constraints.contacts, blocks.comm);
  return body_groups(blocks.decomposition, jump, blocks.constraints.prescribed, blocks.comm);
}

// Bodies are numbered by name. The pile is tied from its top down, so that its lowest number has two ways to go.
TEST(BodyGroups, ReachAsFarAsRowsDo)
{
  Blocks blocks({{"a", cube(0, 0)}, {"b", cube(0, 1)}, {"c", cube(0, 2)}, {"alone", cube(5, 0)}},
                {{"a", {2, 1, 1}}, {"b", {1, 2, 1}}, {"c", {1, 1, 1}}, {"alone", {1, 1, 1}}}, [](int) { return 1.0; });
  const auto number = [&](const std::string& name) {
    const auto& bodies = blocks.decomposition.catalogue.bodies;
    return std::find_if(bodies.begin(), bodies.end(), [&](const mesh::Body& b) { return b.name == name; }) - bodies.begin();
  };
  blocks.dirichlet_rows({{"a.zmin", {0, 0, 0}}, {"alone.zmin", {0, 0, 0}}});
  blocks.join("c.zmin", "b.zmax", false);
  blocks.join("b.zmin", "a.zmax", true);
  const auto groups = groups_of(blocks);
  const auto of = [&](const std::string& name) { return groups.of_body[static_cast<std::size_t>(number(name))]; };
  EXPECT_EQ(of("a"), of("b"));
  EXPECT_EQ(of("b"), of("c"));
  EXPECT_NE(of("a"), of("alone"));
  long long pile = 0, alone = 0;
  for (const int group : groups.of_row) {
    pile += group == of("a");
    alone += group == of("alone");
  }
  EXPECT_EQ(pile + alone, static_cast<long long>(groups.of_row.size()));
  EXPECT_EQ(blocks.comm.sum(alone), 27);
}

TEST(BodyGroups, CouplingsTieWhatTheyMoveAndNotWhatTheyHold)
{
  Blocks blocks({{"a", cube(0, 0)}, {"b", cube(5, 0)}}, {{"a", {1, 1, 1}}, {"b", {1, 1, 1}}}, [](int) { return 1.0; });
  blocks.dirichlet_rows({{"a.zmin", {0, 0, 0}}, {"b.zmin", {0, 0, 0}}});
  for (auto& dof : blocks.constraints.prescribed) dof.coupling = 0;
  EXPECT_NE(groups_of(blocks).of_body[0], groups_of(blocks).of_body[1]);
  for (auto& dof : blocks.constraints.prescribed) dof.unknown = true;
  EXPECT_EQ(groups_of(blocks).of_body[0], groups_of(blocks).of_body[1]);
}

}  // namespace
}  // namespace mortise::feti
