// Coulomb's law on a wedge between two walls, pressed down and pushed along them. Where all sticks the walls hardly press, since
// shear bears the load; friction of such pressures would not hold the push. In truth the wedge goes deeper, is pressed the more,
// and stays: bounds that leave no feasible point have to be left behind. Deeper walls press more and friction holds more, so that
// less is pressed: bounds swing about the solution, and plain steps would not settle. All of it in closed form, see WedgeForces.
#include "friction/coulomb.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "../src/equilibrium.hpp"
#include "base/error.hpp"
#include "testing/proximal_gradient.hpp"
#include "testing/rough_operator.hpp"
#include "wedge.hpp"

namespace mortise::friction {
namespace {

constexpr double coefficient = 0.3;

struct Push {
  double slope, push;
  int infeasible = 0;  // Tresca problems of the fixed point, one after the other, that have no feasible point
  double times = 1;    // the first bounds that leave one, over those of the pressures where all sticks
};
std::ostream& operator<<(std::ostream& out, const Push& p)
{
  return out << "slope " << p.slope << " push " << p.push;
}

class Wedges : public testing::TestWithParam<Push> {
 protected:
  WedgeForces known{GetParam().slope, GetParam().push, coefficient};
  Wedge wedge{GetParam().slope, GetParam().push};
  feti::DualProblem problem = wedge.problem();

  // The forces of these multipliers against those with a slip bound, over all points; 1 is a point's load. Collective.
  double distance(const Vector& x, double bound) const
  {
    const Eigen::VectorXd forces = forces_of(problem, x, Wedge::count);
    const Eigen::Vector3d expected(known.normal(bound), known.push, -known.up(bound));
    return (forces.reshaped(3, Wedge::count).colwise() - expected).norm();
  }
};
// Bounds are doubled, for those before were infinite: twice in the second case, which is enough. In the third three times are
// not, and those of the nearest forces within the cones that balance the loads come next: they hold just as much as they have to.
INSTANTIATE_TEST_SUITE_P(Pushed, Wedges, testing::Values(Push{20, 0.05, 0, 1}, Push{20, 0.3, 2, 4}, Push{10, 0.8, 4, 0}));

TEST_P(Wedges, ObeyTheLawByEverySolver)
{
  for (const char* algorithm : {"face_newton", "smalse", "direct"}) {
    const double tolerance = algorithm == std::string("smalse") ? 1e-6 : 1e-8;
    CoulombStep step(problem, coefficient, algorithm, tolerance);
    const auto found = step.solve();
    EXPECT_TRUE(found.converged) << algorithm;
    EXPECT_LT(distance(found.solution.x, known.bound()), 100 * tolerance) << algorithm;
  }
}

// Follows no law, and solves its Tresca problems more exactly than it is asked to. Keeps what it was asked.
class TrescaAlone : public qp::Solver {
 public:
  struct Asked {
    std::vector<double> radii;
    bool feasible;
  };
  TrescaAlone(std::unique_ptr<qp::Solver> solver, std::vector<Asked>& asked) : solver_(std::move(solver)), asked_(asked) {}
  using qp::Solver::solve;
  qp::Solution solve(const qp::RightHandSide& right, std::span<const double> radii, const std::optional<qp::Solution>& start,
                     const qp::Goal& goal, const qp::Observer& observer, qp::Foreknown* known) override
  {
    auto exact = goal;
    exact.residual = 1e-11;
    auto solution = solver_->solve(right, radii, start, exact, observer, known);
    asked_.push_back({{radii.begin(), radii.end()}, solution.feasible});
    return solution;
  }
  qp::ActiveSetPreconditioner* preconditioner() override { return solver_->preconditioner(); }

 private:
  std::unique_ptr<qp::Solver> solver_;
  std::vector<Asked>& asked_;
};

TEST_P(Wedges, TakeBoundsBackThatLeaveNothingAndFollowAitkensRule)
{
  std::vector<TrescaAlone::Asked> asked;
  CoulombStep step(problem, coefficient, "face_newton", 1e-8);
  step.solver = std::make_unique<TrescaAlone>(std::move(step.solver), asked);
  const auto found = step.solve();
  EXPECT_TRUE(found.converged);
  EXPECT_LT(distance(found.solution.x, known.bound()), 1e-6);
  EXPECT_EQ(found.steps, static_cast<int>(asked.size()));

  std::vector<double> bounds;
  for (const auto& [radii, feasible] : asked) {
    const auto own = problem.slip_bounds(problem.set().with_radii(radii));
    bounds.push_back(wedge.comm.max(own.empty() ? 0.0 : own.front()));
    for (const double bound : own)
      if (std::isfinite(bound)) EXPECT_NEAR(bound, bounds.back(), 1e-7);
    EXPECT_EQ(feasible, bounds.back() >= known.push);
  }
  // Stuck first; then what the pressures allow; and twice as much, as long as that is too little.
  const auto& [slope, push, infeasible, times] = GetParam();
  const double first = known.next(std::numeric_limits<double>::infinity());
  ASSERT_GE(bounds.size(), static_cast<std::size_t>(infeasible) + 4);
  EXPECT_TRUE(std::isinf(bounds[0]));
  for (int i = 0; i < std::min(infeasible, 3); ++i) EXPECT_NEAR(bounds[1 + i], std::pow(2, i) * first, 1e-8);
  const auto begin = static_cast<std::size_t>(infeasible) + 1;
  EXPECT_NEAR(bounds[begin], times > 0 ? times * first : known.bound() * (1 + 1e-6), 1e-8);
  // From there Aitken's rule, which is the secant's: where next(bound) - bound would be nothing, but no less than a twentieth of
  // the way to next(bound), and no more than that way.
  EXPECT_LE(bounds.size(), begin + 10);
  const double part = (bounds[begin + 1] - bounds[begin]) / (known.next(bounds[begin]) - bounds[begin]);
  EXPECT_GE(part, 0.05 - 1e-3);
  EXPECT_LE(part, 1 + 1e-3);
  int inside = 0;
  for (auto i = begin + 1; i + 1 < bounds.size(); ++i) {
    const double step_before = known.next(bounds[i - 1]) - bounds[i - 1], way = known.next(bounds[i]) - bounds[i];
    if (std::abs(way) < 1e-5 || std::abs(bounds[i] - bounds[i - 1]) < 1e-5) break;  // rounding decides
    const double secant = (bounds[i] - bounds[i - 1]) / (step_before - way);
    inside += secant > 0.05 && secant < 1;
    EXPECT_NEAR(bounds[i + 1], bounds[i] + std::clamp(secant, 0.05, 1.0) * way, 1e-6) << i;
  }
  if (times > 0) EXPECT_GE(inside, 2);
}

// Rough products let face Newton come near by itself and with bounds, and no nearer; SMALSE-M, whose products are exact, goes on
// to the solution of its Tresca problem, and so to that of the whole.
class WedgesAndRoughProducts : public Wedges {};
INSTANTIATE_TEST_SUITE_P(Pushed, WedgesAndRoughProducts, testing::Values(Push{20, 0.05}, Push{20, 0.3}));

TEST_P(WedgesAndRoughProducts, ObeyTheLawBySmalseWhereFaceNewtonCrawls)
{
  constexpr double off = 1e-5;
  RoughOperator product(problem.hessian(), off);
  CoulombStep step(problem, product, coefficient, "face_newton", 1e-6);
  step.options.tolerance = 1e-4;
  std::set<int> of_smalse, of_faces;  // Tresca problems
  step.watch = [&](int number, const qp::Progress& progress) {
    if (progress.what == "norm") return;
    product.exact = progress.precision > 0;
    (product.exact ? of_smalse : of_faces).insert(number);
  };
  const auto found = step.solve();
  EXPECT_TRUE(found.converged);
  EXPECT_LT(distance(found.solution.x, known.bound()), 1e-3);
  ASSERT_FALSE(of_smalse.empty());
  for (const int number : of_smalse) EXPECT_EQ(of_faces.count(number), 1U);
  EXPECT_EQ(*of_smalse.rbegin(), found.steps);
}

// Bounds of which all is needed hold the push, to a thousandth.
TEST_P(Wedges, AreHeldByBoundsThatAreNoLessThanThePush)
{
  CoulombStep step(problem, coefficient, "face_newton", 1e-8);
  const auto found = step.solve();
  const auto held = [&](double part) {
    const std::vector<double> bounds(problem.set().discs().size(), part * known.push);
    return balances(problem, step.omega, problem.radii(bounds), found.solution.x);
  };
  EXPECT_TRUE(held(1));
  EXPECT_TRUE(held(1 - 5e-4));
  EXPECT_FALSE(held(1 - 1e-2));
}

TEST(WedgesPushedTooHard, AreInNoEquilibrium)
{
  const double greatest = WedgeForces::greatest_push(20, coefficient);
  for (const double part : {0.5, 1.05, 2.0})
    for (const char* algorithm : {"face_newton", "smalse"}) {
      Wedge wedge(20, part * greatest);
      const auto problem = wedge.problem();
      CoulombStep step(problem, coefficient, algorithm, 1e-6);
      try {
        EXPECT_TRUE(step.solve().converged) << algorithm;
        EXPECT_LT(part, 1) << algorithm << " throws no error";
      } catch (const Error& error) {
        EXPECT_GT(part, 1) << error.what();
        EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
        EXPECT_NE(std::string(error.what()).find("wedge"), std::string::npos) << error.what();
      }
    }
}

}  // namespace
}  // namespace mortise::friction
