#include "qp/feasible_set.hpp"

#include <gtest/gtest.h>

#include <random>

namespace mortise::qp {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Unknowns: 0 free, 1 bounded, (2, 3) a disc away from the origin, 4 an interval, (5, 6) pinned, (7, 8) an infinite disc.
FeasibleSet sample()
{
  return {{{1, -0.5}},
          {{{2, 3}, 1.5, {0.4, -0.2}}, {{4, -1}, 0.7, {0.1, 0}}, {{5, 6}, 0, {0.3, 0.1}}, {{7, 8}, infinite, {0, 0}}}};
}

Eigen::VectorXd random(std::mt19937& generator, double scale)
{
  std::normal_distribution<double> normal(0, scale);
  return Eigen::VectorXd::NullaryExpr(9, [&](Eigen::Index) { return normal(generator); });
}

// Normal unknowns 0 and 3 with cones over (1, 2) and over 4 alone.
TEST(FeasibleSet, ConesAreProjectedOn)
{
  FeasibleSet discs({{0, 0}, {3, 0}}, {{{1, 2}, 0, {0, 0}, 0, 0.3}, {{4, -1}, 0, {0, 0}, 3, 1.5}});
  const FeasibleSet set = discs.with_cones();
  std::mt19937 generator(2);
  int inside = 0, tips = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::VectorXd x = random(generator, 2);
    Eigen::VectorXd p = x, other = random(generator, 2);
    set.project(p);
    set.project(other);
    EXPECT_LE((x - p).dot(other - p), 1e-12);
    EXPECT_LE(std::hypot(p[1], p[2]), 0.3 * p[0] + 1e-14);
    EXPECT_LE(std::abs(p[4]), 1.5 * p[3] + 1e-14);
    Eigen::VectorXd again = p;
    set.project(again);
    EXPECT_LT((again - p).norm(), 1e-13);
    inside += p == x;
    tips += p[0] == 0;
  }
  EXPECT_GT(inside, 0);
  EXPECT_GT(tips, 10);
  EXPECT_FALSE(discs.has_cones());
}

TEST(FeasibleSet, ProjectionIsNearestPoint)
{
  std::mt19937 generator(1);
  const auto set = sample();
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd x = random(generator, 2);
    Eigen::VectorXd p = x, other = random(generator, 2);
    set.project(p);
    set.project(other);
    EXPECT_LE((x - p).dot(other - p), 1e-12);  // the variational inequality that defines the projection
    Eigen::VectorXd again = p;
    set.project(again);
    EXPECT_LT((again - p).norm(), 1e-14);
  }
}

TEST(FeasibleSet, FeasibleStepReachesTheBoundaryAndNoFarther)
{
  std::mt19937 generator(2);
  const auto set = sample();
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::VectorXd x = random(generator, 1), p = random(generator, 1);
    set.project(x);
    p[5] = p[6] = 0;  // a pinned disc allows no step at all
    const double step = set.feasible_step(x, p);
    ASSERT_TRUE(std::isfinite(step));
    Eigen::VectorXd inside = x - 0.999999 * step * p, outside = x - (1.000001 * step + 1e-9) * p;
    Eigen::VectorXd a = inside, b = outside;
    set.project(a);
    set.project(b);
    EXPECT_LT((a - inside).norm(), 1e-12);
    EXPECT_GT((b - outside).norm(), 0);
  }
}

TEST(FeasibleSet, ShiftedSetProjectsAlike)
{
  std::mt19937 generator(3);
  const auto set = sample();
  const Eigen::VectorXd shift = random(generator, 1), x = random(generator, 2);
  Eigen::VectorXd direct = x, shifted = x - shift;
  set.project(direct);
  set.shifted(shift).project(shifted);
  EXPECT_LT((shifted + shift - direct).norm(), 1e-13);
}

TEST(FeasibleSet, SplitVanishesExactlyAtAMinimiser)
{
  const FeasibleSet set({{0, 0}}, {{{1, 2}, 1.0, {0, 0}}});
  Eigen::VectorXd x(3), g(3), free(3), chopped(3);
  x << 0, 0.6, 0.8;
  g << 2, -0.6, -0.8;  // pushes into the bound and out of the disc: nothing is left to gain
  set.split(x, g, free, chopped);
  EXPECT_LT(free.norm() + chopped.norm(), 1e-14);
  g << -2, 0.8, -0.6;  // off the bound, along the circle
  set.split(x, g, free, chopped);
  EXPECT_EQ(free.norm(), 0);
  EXPECT_NEAR(chopped[0], -2, 1e-14);
  EXPECT_NEAR(chopped[1], 0.8, 1e-14);
  g << 1, 0.6, 0.8;  // into the disc
  set.split(x, g, free, chopped);
  EXPECT_NEAR(chopped.tail(2).norm(), 1, 1e-14);
  EXPECT_EQ(set.active(x).bounds, 1);
  EXPECT_EQ(set.active(x).discs, 1);
}

TEST(FeasibleSet, PinnedDiscIsNeitherFreeNorChopped)
{
  const FeasibleSet set({}, {{{0, 1}, 0, {0, 0}}});
  const Eigen::VectorXd x = Eigen::VectorXd::Zero(2), g = Eigen::VectorXd::Ones(2);
  Eigen::VectorXd free(2), chopped(2);
  set.split(x, g, free, chopped);
  EXPECT_EQ(free.norm() + chopped.norm(), 0);
  EXPECT_EQ(set.feasible_step(x, g), infinite);
  EXPECT_EQ(set.active(x).discs, 0);
}

}  // namespace
}  // namespace mortise::qp
