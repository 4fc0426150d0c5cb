// A wedge between two walls, pressed down and pushed along them. Where all sticks the walls hardly press, since shear bears the
// load; friction of such pressures would not hold the push. In truth the wedge goes deeper, is pressed the more, and stays:
// bounds that leave no feasible point have to be left behind. Every solver, against proximal gradient steps in displacements.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "testing/proximal_gradient.hpp"
#include "wedge.hpp"

namespace mortise::friction {
namespace {

constexpr double coefficient = 0.3;

// By one rank; and the forces where all sticks. Collective.
std::pair<Reference, Eigen::VectorXd> wedge_reference(double slope, double push)
{
  const Communicator comm;
  std::vector<double> forces, bounds, stuck;
  if (comm.root()) {
    const Wedge wedge(slope, push, 1, MPI_COMM_SELF);
    const auto& mesh = wedge.decomposition.subdomains[0].mesh;
    const auto count = static_cast<Eigen::Index>(wedge.points.size()), w = 3 * count;
    Eigen::Index next = w;
    Eigen::MatrixXd t = Eigen::MatrixXd::Zero(wedge.load[0].size(), wedge.load[0].size());  // from w and all others to u
    for (std::size_t n = 0; n < mesh.node_id.size(); ++n) {
      const auto row = 3 * static_cast<Eigen::Index>(n);
      const auto at = std::find(wedge.points.begin(), wedge.points.end(), mesh.node_id[n]) - wedge.points.begin();
      if (at < count)
        for (int k = 0; k < 3; ++k)
          t.block(row, 3 * at + k, 3, 1) = wedge.frame[static_cast<std::size_t>(at)][static_cast<std::size_t>(k)];
      else
        t.block(row, std::exchange(next, next + 3), 3, 3).setIdentity();
    }
    const Eigen::MatrixXd lower = fem::stiffness(mesh, fem::Material{100, 0.3, 0, 0}, fem::Kinematics::solid);
    const Eigen::MatrixXd whole = lower.selfadjointView<Eigen::Lower>(), k = t.transpose() * whole * t;
    const Eigen::VectorXd f = t.transpose() * wedge.load[0];
    const Eigen::Index rest = next - w;
    const Eigen::MatrixXd inner = k.bottomRightCorner(rest, rest).llt().solve(k.bottomLeftCorner(rest, w));
    const Eigen::MatrixXd s = k.topLeftCorner(w, w) - k.topRightCorner(w, rest) * inner;
    // From bounds that are enough, for with too small ones nothing holds the wedge.
    const Eigen::VectorXd c = f.head(w) - inner.transpose() * f.tail(rest);
    const auto found = by_proximal_gradient(s, c, {Law::Kind::coulomb, coefficient}, Eigen::VectorXd::Constant(count, 0.1), 0.3);
    forces.assign(found.forces.begin(), found.forces.end());
    bounds.assign(found.bounds.begin(), found.bounds.end());
    stuck.assign(c.begin(), c.end());
  }
  comm.broadcast(forces);
  comm.broadcast(bounds);
  comm.broadcast(stuck);
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  return {{vector(forces), vector(bounds)}, vector(stuck)};
}

struct Push {
  double slope, push;
  int infeasible;  // Tresca problems of the fixed point, one after the other, that have no feasible point
  double times;    // the first bounds that leave one, over those of the pressures where all sticks
};
std::ostream& operator<<(std::ostream& out, const Push& p)
{
  return out << "slope " << p.slope << " push " << p.push;
}

class Wedges : public testing::TestWithParam<Push> {};
// Bounds are doubled, for those before were infinite: twice in the first case, which is enough. In the second three times are
// not, and those of the nearest forces within the cones that balance the loads come next: they hold just as much as they have to.
INSTANTIATE_TEST_SUITE_P(Pushed, Wedges, testing::Values(Push{20, 0.3, 2, 4}, Push{10, 0.8, 4, 0}));

TEST_P(Wedges, GoBackFromBoundsThatLeaveNothing)
{
  const auto [slope, push, infeasible, times] = GetParam();
  const auto [expected, stuck] = wedge_reference(slope, push);
  const double size = expected.forces.norm();
  double first = 0, most = 0;  // bounds of the pressures where all sticks; friction along the push at the solution
  for (Eigen::Index p = 0; p < expected.bounds.size(); ++p) {
    EXPECT_GT(expected.forces[3 * p], 0);
    EXPECT_NEAR(expected.forces.segment(3 * p + 1, 2).norm(), coefficient * expected.forces[3 * p], 1e-9);
    first += coefficient * std::max(stuck[3 * p], 0.0);
    most += expected.forces[3 * p + 1];
  }
  EXPECT_NEAR(most, push, 1e-9);
  EXPECT_LT(first, push);  // they would not hold it

  for (const char* algorithm : {"face_newton", "smalse", "direct"}) {
    const bool slow = algorithm == std::string("smalse");
    Wedge wedge(slope, push, slow ? 1 : 3);
    const auto problem = wedge.problem();
    CoulombStep step(problem, coefficient, algorithm, slow ? 1e-6 : 1e-8);
    std::map<int, double> sums;  // of the bounds of each Tresca problem that has a feasible point
    step.watch = [&](int number, const qp::Progress& progress) {
      if (!progress.set) return;
      double sum = 0;
      for (const double bound : problem.slip_bounds(*progress.set)) sum += bound;
      sums.emplace(number, wedge.comm.sum(sum));
    };
    const auto found = step.solve();
    EXPECT_TRUE(found.converged) << algorithm;
    const Eigen::VectorXd forces = forces_of(problem, found.solution.x, wedge.points.size());
    EXPECT_LT((forces - expected.forces).norm(), (slow ? 1e-5 : 1e-7) * size) << algorithm;
    if (!slow) continue;  // the others follow the law in one loop
    ASSERT_GE(sums.size(), 3U);
    const auto second = std::next(sums.begin());
    EXPECT_LE(second->first, 2 + infeasible);
    EXPECT_NEAR(second->second, times > 0 ? times * first : expected.bounds.sum(), 0.02 * second->second);
  }
}

// Twice as far as friction holds at most, 0.3 / sin 20.
TEST(WedgePushedTooHard, IsNoEquilibrium)
{
  for (const char* algorithm : {"face_newton", "smalse"}) {
    Wedge wedge(20, 1.75, 1);
    const auto problem = wedge.problem();
    try {
      CoulombStep(problem, coefficient, algorithm, 1e-6).solve();
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
      EXPECT_NE(std::string(error.what()).find("wedge"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace mortise::friction
