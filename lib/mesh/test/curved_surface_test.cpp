#include "mesh/curved_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mortise::mesh {
namespace {

TEST(CurvedSurface, NamesReadBack)
{
  const CurvedSurface cone{{1.0 / 3, -2e-7, 5e11}, Point(1, 2, -2) / 3, 0.1, -0.25}, sphere{{1, 2, 3}, Point::Zero(), 7.7, 0};
  for (const auto& surface : {cone, sphere}) {
    const auto name = name_of(surface);
    EXPECT_LE(name.size(), 127U);
    const auto again = curved_surface(name);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->point, surface.point);
    EXPECT_LT((again->axis - surface.axis).norm(), 1e-15);
    EXPECT_NEAR(again->radius, surface.radius, 1e-15 * surface.radius);
    EXPECT_EQ(again->slope, surface.slope);
  }
  for (const auto& other : {std::string("bore"), std::string("@curved:"), name_of(cone) + "0", "@curved:" + std::string(112, 'g'),
                            "@curved:" + std::string(112, '0'), "@curved:" + std::string(112, 'f')})
    EXPECT_FALSE(curved_surface(other)) << other;
}

TEST(CurvedSurface, DistanceIsAcrossTheAxis)
{
  const CurvedSurface cylinder{{1, 0, 5}, {0, 0, 1}, 2, 0}, cone{{1, 0, 5}, {0, 0, 1}, 2, 0.5};
  EXPECT_NEAR(cylinder.distance({4, 0, -3}), 1, 1e-15);
  EXPECT_NEAR(cylinder.distance({1, 0.5, 0}), -1.5, 1e-15);
  EXPECT_NEAR(cone.distance({1, 3, 7}), 0, 1e-15);
}

TEST(CurvedSurface, IsTheSameFromAnywhereOnIt)
{
  const CurvedSurface cylinder{{0, 0, 0}, {0, 0, 1}, 10, 0};
  EXPECT_TRUE(same(cylinder, {{0, 0, 40}, {0, 0, -1}, 10, 0}));
  EXPECT_FALSE(same(cylinder, {{0, 0, 40}, {0, 0, -1}, 10.001, 0}));  // a clearance
  EXPECT_FALSE(same(cylinder, {{0.001, 0, 40}, {0, 0, -1}, 10, 0}));  // beside it
  EXPECT_FALSE(same(cylinder, {{0, 0, 0}, {0, 1e-4, 1}, 10, 0}));     // tilted
  EXPECT_FALSE(same(cylinder, {{0, 0, 0}, Point::Zero(), 10, 0}));    // a sphere in it
  const CurvedSurface cone{{0, 0, 0}, {0, 0, 1}, 10, 0.1};
  EXPECT_TRUE(same(cone, {{0, 0, 20}, {0, 0, -1}, 12, -0.1}));
  EXPECT_FALSE(same(cone, {{0, 0, 20}, {0, 0, 1}, 12, -0.1}));  // the other way round
  EXPECT_FALSE(same(cone, {{0, 0, 20}, {0, 0, 1}, 10, 0.1}));   // shifted
  const CurvedSurface sphere{{1, 2, 3}, Point::Zero(), 5, 0};
  EXPECT_TRUE(same(sphere, sphere));
  EXPECT_FALSE(same(sphere, {{1, 2, 3}, Point::Zero(), 4.9, 0}));
}

TEST(CurvedSurface, MovesAndScales)
{
  const CurvedSurface cone{{3, 0, 0}, {1, 0, 0}, 2, 0.5};
  Motion rotation;
  rotation.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Point::UnitZ()).toRotationMatrix();
  rotation.translation = Point(0, 0, 4);
  EXPECT_TRUE(same(moved(cone, rotation), {{0, 3, 4}, {0, 1, 0}, 2, 0.5}));
  EXPECT_TRUE(same(scaled(cone, 25.4), {{76.2, 0, 0}, {1, 0, 0}, 50.8, 0.5}));
}

}  // namespace
}  // namespace mortise::mesh
