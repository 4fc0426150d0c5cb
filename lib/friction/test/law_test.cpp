// The slip bounds of laws of friction, and what changes of them are measured by.
#include "friction/law.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "wedge.hpp"

namespace mortise::friction {
namespace {

using Kind = Law::Kind;
constexpr double infinite = std::numeric_limits<double>::infinity();

// A law for each contact, and points of each.
class SlipBounds : public testing::Test {
 protected:
  static constexpr double area = 0.5;
  SlipBounds()
  {
    auto& nodes = wedge.constraints.contacts.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i].contact = number(i) % 3;
      nodes[i].area = area;
    }
  }
  // Of this rank's i-th point among all.
  int number(std::size_t i) const { return static_cast<int>(i) * wedge.comm.size() + wedge.comm.rank(); }
  // A value for each disc, from the number of its point.
  template <class Value>
  std::vector<double> of_discs(const feti::DualProblem& problem, const Value& value) const
  {
    std::vector<double> result(problem.set().discs().size(), -1);
    const auto& rows = problem.node_rows();
    for (std::size_t i = 0; i < rows.size(); ++i) result[static_cast<std::size_t>(rows[i].disc)] = value(number(i));
    return result;
  }

  Wedge wedge{20, 0};
  const std::vector<Law> laws{{Kind::coulomb, 0.5}, {Kind::tresca, 7}, {Kind::frictionless, 3}};
};

TEST_F(SlipBounds, StickFirstWhereTheyFollowForces)
{
  const auto problem = wedge.problem();
  EXPECT_EQ(wedge.comm.sum(static_cast<long long>(problem.set().discs().size())), static_cast<long long>(Wedge::count));
  EXPECT_EQ(slip_bounds(problem, laws, nullptr), of_discs(problem, [](int point) {
              return std::array{infinite, 7 * area, 0.0}[static_cast<std::size_t>(point % 3)];
            }));
  EXPECT_TRUE(any_coulomb(laws));
  EXPECT_FALSE(any_coulomb({laws[1], laws[2]}));
}

TEST_F(SlipBounds, FollowTheNormalForcesAndAreNothingWithout)
{
  const auto problem = wedge.problem();
  const auto force = [](int point) { return point % 2 == 0 ? 3.0 + point : -3.0; };
  Eigen::VectorXd forces = Eigen::VectorXd::Constant(problem.jump().ranges().end, 100);  // along tangents: of no account
  for (std::size_t i = 0; i < problem.node_rows().size(); ++i) forces[problem.node_rows()[i].normal] = force(number(i));
  const Vector x = problem.multipliers(forces);
  const auto bounds = slip_bounds(problem, laws, &x);
  const auto expected = of_discs(problem, [&](int point) {
    return std::array{0.5 * std::max(force(point), 0.0), 7 * area, 0.0}[static_cast<std::size_t>(point % 3)];
  });
  // The solver's radii stand for the same forces.
  const auto again = problem.slip_bounds(problem.set().with_radii(problem.radii(bounds)));
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    EXPECT_NEAR(bounds[i], expected[i], 1e-12);
    EXPECT_NEAR(again[i], expected[i], 1e-12);
    EXPECT_GE(bounds[i], 0);
  }
}

TEST_F(SlipBounds, HaveCoefficientsWhereTheyFollowForces)
{
  const auto problem = wedge.problem();
  const auto set = with_coefficients(problem.system(), laws);
  std::vector<double> coefficients;
  for (const auto& disc : set.discs()) coefficients.push_back(disc.coefficient);
  EXPECT_EQ(coefficients, of_discs(problem, [](int point) { return point % 3 == 0 ? 0.5 : 0.0; }));
}

// Eight bounds of 2 that were 3, of which some do not count.
TEST_F(SlipBounds, ChangeByWhatTheFiniteOnesDo)
{
  const auto problem = wedge.problem();
  const auto change = [&](int infinite_next, int infinite_now, double least) {
    return relative_change(problem, of_discs(problem, [=](int point) { return point < infinite_next ? infinite : 2.0; }),
                           of_discs(problem, [=](int point) { return point < infinite_now ? infinite : 3.0; }), least);
  };
  EXPECT_NEAR(change(0, 0, 0), 0.5, 1e-12);
  EXPECT_NEAR(change(0, 3, 0), std::sqrt(5.0 / (8 * 4)), 1e-12);  // bounds that come from infinity are no change, but a size
  EXPECT_NEAR(change(3, 5, 0), std::sqrt(3.0 / (5 * 4)), 1e-12);
  EXPECT_NEAR(change(0, 0, 100), std::sqrt(8.0) / 100, 1e-12);
  EXPECT_EQ(change(8, 0, 0), 0);
}

}  // namespace
}  // namespace mortise::friction
