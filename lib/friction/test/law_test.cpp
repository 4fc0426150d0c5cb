// The slip bounds of laws of friction.
#include "friction/law.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "wedge.hpp"

namespace mortise::friction {
namespace {

using Kind = Law::Kind;

TEST(SlipBounds, StickFirstAndFollowTheNormalForces)
{
  Wedge wedge(20, 0, 1);
  const auto problem = wedge.problem();
  const auto count = problem.set().discs().size();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(slip_bounds(problem, {{Kind::coulomb, 0.5}}, nullptr), std::vector<double>(count, infinite));
  EXPECT_EQ(slip_bounds(problem, {{Kind::frictionless, 0}}, nullptr), std::vector<double>(count, 0.0));
  for (const auto& [kind, coefficient] : {std::pair(Kind::coulomb, 0.5), std::pair(Kind::tresca, 0.0)}) {
    const qp::FeasibleSet set = with_coefficients(problem.system(), {{kind, 0.5}});
    EXPECT_EQ(set.discs().size(), count);
    for (const auto& disc : set.discs()) EXPECT_EQ(disc.coefficient, coefficient);
  }
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(problem.jump().ranges().end);
  for (std::size_t i = 0; i < problem.node_rows().size(); ++i) forces[problem.node_rows()[i].normal] = i % 2 == 0 ? 3.0 : -3.0;
  const Vector x = problem.multipliers(forces);
  const auto coulomb = slip_bounds(problem, {{Kind::coulomb, 0.5}}, &x), tresca = slip_bounds(problem, {{Kind::tresca, 7}}, &x);
  for (std::size_t i = 0; i < problem.node_rows().size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    const auto disc = static_cast<std::size_t>(rows.disc);
    EXPECT_NEAR(coulomb[disc], i % 2 == 0 ? 1.5 : 0.0, 1e-12);
    EXPECT_EQ(tresca[disc], 7);  // a force, on an area of 1
    // The solver's radii stand for the same forces.
    const qp::FeasibleSet set = problem.set().with_radii(problem.radii(coulomb));
    EXPECT_NEAR(problem.slip_bounds(set)[disc], coulomb[disc], 1e-12);
  }
}

}  // namespace
}  // namespace mortise::friction
