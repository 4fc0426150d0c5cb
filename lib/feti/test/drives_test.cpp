#include "feti/drives.hpp"

#include <gtest/gtest.h>

namespace mortise::feti {
namespace {

// Along the axis of a pin of 16 facets, that rows do not feel; or about it.
FreeMotion on_a_pin(bool turns)
{
  FreeMotion motion;
  motion.motions.push_back({0, Point::Zero(), turns ? Point::Zero() : Point(0, 0, 1), turns ? Point(0, 0, 0.5) : Point::Zero()});
  motion.sagitta = 0.02;
  motion.turning = turns ? 1e10 : 0;
  motion.force = 3000;
  return motion;
}

TEST(Drives, a_component_along_the_axis_of_facets_is_refused)
{
  const auto limits = drive_limits(on_a_pin(false), 0);
  EXPECT_LT(limits.refused, 3.0 / 3100);
  EXPECT_GT(limits.refused, 1e-5);  // numbers typed with five digits
  EXPECT_LT(limits.told, 1e-6);
  EXPECT_GT(limits.told, 1e-10);  // rounding
}

TEST(Drives, pressures_on_curved_faces_and_felt_or_turning_motions_are_known_less_well)
{
  auto motion = on_a_pin(false);
  EXPECT_DOUBLE_EQ(drive_limits(motion, 0.5).told, 5e-3);
  EXPECT_DOUBLE_EQ(drive_limits(motion, 1).refused, 1e-2);  // what facets may make of other loads
  motion.turning = 1e-3;
  EXPECT_DOUBLE_EQ(drive_limits(motion, 0).told, 1e-3);
  motion.resistance = 1e-2;
  EXPECT_DOUBLE_EQ(drive_limits(motion, 0).refused, 3e-2);
}

TEST(Drives, facets_move_the_centre_of_mass_beside_the_axis)
{
  const auto motion = on_a_pin(true);
  EXPECT_DOUBLE_EQ(drive_limits(motion, 0).refused, 0.01);
  EXPECT_DOUBLE_EQ(drive_limits(motion, 0).told, 0.006);
}

TEST(Drives, a_flat_side_knows_its_plane)
{
  auto motion = on_a_pin(false);
  motion.sagitta = 0;
  EXPECT_DOUBLE_EQ(drive_limits(motion, 0).refused, 1e-6);
}

TEST(Drives, tell_a_force_or_a_moment)
{
  auto motion = on_a_pin(false);
  motion.work = 1e-3;
  const auto pulled = unresisted_load(motion, 1e-9, 10);
  EXPECT_FALSE(pulled.turns);
  EXPECT_DOUBLE_EQ(pulled.force, 3);
  EXPECT_EQ(pulled.motion, "moves along (0, 0, 1)");
  EXPECT_TRUE(pulled.of_facets);
  motion = on_a_pin(true);
  motion.work = 1e-3;
  const auto turned = unresisted_load(motion, 1e-9, 10);
  EXPECT_TRUE(turned.turns);
  EXPECT_DOUBLE_EQ(turned.force, 6);
}

}  // namespace
}  // namespace mortise::feti
