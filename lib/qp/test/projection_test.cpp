#include "qp/projection.hpp"

#include <gtest/gtest.h>

#include "dense_operator.hpp"
#include "testing/quiet.hpp"

namespace mortise::qp {
namespace {

// All unknowns of this rank >= 0.
FeasibleSet pushing(const Map& map)
{
  std::vector<Bound> bounds;
  for (Local i = 0; i < static_cast<Local>(map.getNodeNumElements()); ++i) bounds.push_back({i, 0});
  return {std::move(bounds), {}};
}

// sum x = total over n unknowns, x >= 0: the projection is max(y - nu, 0) with one nu that fits.
TEST(Projection, SimplexHasItsKnownForm)
{
  constexpr int n = 30;
  const auto map = even_map(n, world());
  Eigen::VectorXd y(n);
  for (int i = 0; i < n; ++i) y[i] = std::sin(3.0 * i);
  const FeasibleSet set = pushing(*map);
  const EqualityConstraint equality(local_columns(Eigen::MatrixXd::Ones(1, n), *map), world());
  const Eigen::VectorXd e = Eigen::VectorXd::Constant(1, 2.5);
  const Projection result = project(local_part(y, map), equality, e, set);
  ASSERT_TRUE(result.found);
  const Eigen::VectorXd x = gathered(result.point, world());
  EXPECT_NEAR(x.sum(), 2.5, 1e-11);
  EXPECT_LT((x - (y.array() - result.nu[0]).max(0).matrix()).norm(), 1e-12);
}

// A body that hangs on one soft spring while all its contact points are open: what is little beside the forces that would close
// these is all that the spring feels.
TEST(Projection, SoftSpringsAreExactAsWell)
{
  constexpr int n = 30;
  constexpr double soft = 1e-5;
  const auto map = even_map(n, world());
  std::vector<Bound> bounds;
  for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i)
    if (map->getGlobalElement(i) > 0) bounds.push_back({i, 0});
  const FeasibleSet set(bounds, {});
  Eigen::MatrixXd g = Eigen::MatrixXd::Constant(1, n, -1);
  g(0, 0) = soft;
  const EqualityConstraint equality(local_columns(g, *map), world());
  const Eigen::VectorXd e = Eigen::VectorXd::Constant(1, 3 * soft);
  const Projection result = project(local_part(Eigen::VectorXd::Constant(n, -10), map), equality, e, set);
  ASSERT_TRUE(result.found);
  const Eigen::VectorXd x = gathered(result.point, world());
  EXPECT_NEAR(x[0], 3, 1e-10);
  EXPECT_EQ(x.tail(n - 1).norm(), 0);
  EXPECT_NEAR(result.nu[0] * soft, -13, 1e-9);
}

TEST(Projection, TellsThatNothingIsFeasible)
{
  constexpr int n = 6;
  const auto map = even_map(n, world());
  const FeasibleSet set = pushing(*map);
  // Pushing bodies pull: a sum of forces that are all >= 0 cannot be -1.
  const EqualityConstraint equality(local_columns(Eigen::MatrixXd::Ones(1, n), *map), world());
  const Eigen::VectorXd e = Eigen::VectorXd::Constant(1, -1);
  const Projection result = project(Vector(map), equality, e, set);
  EXPECT_FALSE(result.found);
  EXPECT_GT(result.nu[0], 1);
}

// A block of weight 1 between a smooth floor, two forces n >= 0, and a wall to its right, w >= 0, that a small force pulls to the
// left.
TEST(Projection, ProvesThatLittleIsOutOfReach)
{
  constexpr int n = 3;
  const auto map = even_map(n, world());
  const FeasibleSet set = pushing(*map);
  for (const double pull : {-1e-6, 1e-6}) {
    // Up, to the left, and turning about the middle of the floor, where the wall presses half as high as the floor is long.
    const Eigen::MatrixXd g{{1, 1, 0}, {0, 0, 1}, {-1, 1, 0.5}};
    const EqualityConstraint equality(local_columns(g, *map), world());
    const Eigen::VectorXd e = Eigen::Vector3d(1, pull, 0.1);
    Projector projector(equality, set);
    Projection result = projector(Vector(map), e, set);
    EXPECT_EQ(result.found, pull > 0);
    if (result.found || result.empty) continue;
    ASSERT_TRUE(projector.prove_empty(e, set, result));
    EXPECT_GT(-result.nu.dot(e), 0);
    EXPECT_LE((-g.transpose() * result.nu).maxCoeff(), 1e-10 * (g.transpose() * result.nu).cwiseAbs().maxCoeff());
  }
}

TEST(Projection, DiscsLimitWhatFrictionCanCarry)
{
  constexpr int n = 6;
  const Local blocks = n / 2 / world().size() + (world().rank() < n / 2 % world().size() ? 1 : 0);
  const auto map = Teuchos::rcp(new Map(n, static_cast<std::size_t>(2 * blocks), 0, teuchos(world())));
  std::vector<Disc> discs;
  for (Local i = 0; i < 2 * blocks; i += 2) discs.push_back({{i, i + 1}, 1.0, {0, 0}});
  const FeasibleSet set({}, discs);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(2, n);  // resultant in both directions
  for (int i = 0; i < n; ++i) g(i % 2, i) = 1;
  const EqualityConstraint equality(local_columns(g, *map), world());
  EXPECT_TRUE(project(Vector(map), equality, Eigen::Vector2d(2.0, 2.0), set).found);   // 2.83 of 3
  EXPECT_FALSE(project(Vector(map), equality, Eigen::Vector2d(2.2, 2.2), set).found);  // 3.11 of 3
}

// Points with a normal unknown and two tangential ones: pressed together by 6, they carry 0.3 * 6 sideways, whatever share of the
// pressure each of them takes.
TEST(Projection, ConesLimitWhatFrictionCanCarry)
{
  constexpr int n = 12;
  const Local blocks = n / 3 / world().size() + (world().rank() < n / 3 % world().size() ? 1 : 0);
  const auto map = Teuchos::rcp(new Map(n, static_cast<std::size_t>(3 * blocks), 0, teuchos(world())));
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  for (Local i = 0; i < 3 * blocks; i += 3) {
    bounds.push_back({i, 0});
    discs.push_back({{i + 1, i + 2}, 0, {0, 0}, i, 0.3});
  }
  const FeasibleSet set = FeasibleSet(bounds, discs).with_cones();
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(3, n);
  for (int i = 0; i < n; ++i) g(i % 3, i) = 1;
  const EqualityConstraint equality(local_columns(g, *map), world());
  const auto at = [](double sideways) { return Eigen::VectorXd(Eigen::Vector3d(6, 0.6 * sideways, 0.8 * sideways)); };
  const Eigen::VectorXd holds = at(1.8 * 0.9999), slips = at(1.8 * 1.0001);
  const Projection result = project(Vector(map), equality, holds, set);
  ASSERT_TRUE(result.found);
  Eigen::VectorXd sum = g * gathered(result.point, world());
  EXPECT_LT((sum - holds).norm(), 1e-9);
  EXPECT_FALSE(project(Vector(map), equality, slips, set).found);
}

}  // namespace
}  // namespace mortise::qp
