// Load states on one dual system: other loads and bounds of the same rows, on a cube cut into eight. The same on any ranks.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "cube.hpp"
#include "feti/displacements.hpp"

namespace mortise::feti {
namespace {

// Other loads and another prescribed displacement: what with_loads() makes is what a problem of its own would be, to rounding.
TEST(LoadStates, OneOfOtherLoadsAndBoundsIsAsIfItWereAlone)
{
  Cube cube(10, true);
  const auto problem = cube.problem();
  const auto before = problem.right_hand_side();
  const Vector d(before->b, Teuchos::Copy);
  for (auto& f : cube.load) f *= -2.5;
  for (auto& prescribed : cube.constraints.prescribed) prescribed.value += 0.125 * prescribed.component;
  const auto next = problem.with_loads(cube.shared_constraints(), cube.load);
  ASSERT_TRUE(next);
  EXPECT_EQ(&next->system(), &problem.system());
  const auto fresh = cube.problem();
  const auto now = next->right_hand_side(), expected = fresh.right_hand_side();
  const auto apart = [](const Vector& a, const Vector& b) {
    Vector difference(a, Teuchos::Copy);
    difference.update(-1, b, 1);
    return difference.norm2();
  };
  EXPECT_LT(apart(now->b, expected->b), 1e-12 * expected->b.norm2());
  EXPECT_LT((now->e - expected->e).norm(), 1e-12 * before->e.norm());
  EXPECT_GT((now->e - before->e).norm(), 0.1 * before->e.norm());
  EXPECT_EQ(problem.right_hand_side(), before);
  EXPECT_EQ(apart(d, before->b), 0);
  EXPECT_GT(apart(now->b, before->b), 0.1 * before->b.norm2());
}

// Two load states on one system at once, solved by two who know nothing of each other, one in the midst of the other: each has
// its own solution, as it would have alone, and the way back to it.
TEST(LoadStates, TwoOnOneSystemAreApart)
{
  Cube cube(10, true);
  const auto one = cube.problem();
  const auto load = cube.load;
  for (auto& f : cube.load) f *= -2.5;
  for (auto& prescribed : cube.constraints.prescribed) prescribed.value += 0.125 * prescribed.component;
  const auto other = one.with_loads(cube.shared_constraints(), cube.load).value();
  struct Found {
    qp::Solution solution;
    std::vector<Eigen::VectorXd> u;
  };
  const auto solve = [](const DualProblem& problem, const qp::Observer& observer) {
    const auto preconditioner = problem.system().make_preconditioner();
    const RememberedProduct product(problem.system().hessian());
    qp::Hessian hessian(product, 1000);
    const qp::Programme programme{hessian, problem.equality(), problem.set()};
    auto solution = qp::FaceNewton(programme, preconditioner.get())
                        .solve(*problem.right_hand_side(), programme.set.radii(), nullptr, {}, {1e-10, {}}, observer);
    EXPECT_TRUE(solution.converged);
    Displacements displacements(problem, product);
    auto u = displacements.at(solution.x, solution.nu);
    return Found{std::move(solution), std::move(u)};
  };
  const Found alone = solve(one, {}), other_alone = solve(other, {});
  std::optional<Found> amid;
  const Found around = solve(one, [&](const qp::Progress&) {
    if (!amid) amid = solve(other, {});
  });
  ASSERT_TRUE(amid);
  const auto expect_same = [](const Found& a, const Found& b) {
    EXPECT_EQ(view(a.solution.x), view(b.solution.x));
    EXPECT_EQ(a.u, b.u);
  };
  expect_same(around, alone);
  expect_same(*amid, other_alone);
  EXPECT_LT(one.imbalance(around.u, around.solution.x), 1e-9);
  EXPECT_LT(other.imbalance(amid->u, amid->solution.x), 1e-9);
  EXPECT_GT(one.imbalance(amid->u, amid->solution.x), 0.1);
  EXPECT_EQ(one.load(), load);
  EXPECT_EQ(other.load(), cube.load);
  const Found own_system = solve(cube.problem(), {});
  double apart = 0, size = 0;
  for (std::size_t s = 0; s < amid->u.size(); ++s) {
    apart += (amid->u[s] - own_system.u[s]).squaredNorm();
    size += own_system.u[s].squaredNorm();
  }
  EXPECT_LT(std::sqrt(cube.comm.sum(apart)), 1e-8 * std::sqrt(cube.comm.sum(size)));
}

TEST(LoadStates, LoadsThatDriveAFreeMotionLaterAreNoEquilibrium)
{
  Cube cube(1, false);
  const auto pulled = cube.load;
  for (auto& f : cube.load) f.setZero();
  const auto problem = cube.problem();
  const auto next = problem.with_loads(cube.shared_constraints(), cube.load);
  ASSERT_TRUE(next);
  for (const auto* last : {&problem, &*next}) try {
      last->with_loads(cube.shared_constraints(), pulled);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
      EXPECT_NE(std::string(error.what()).find("driven by its loads"), std::string::npos);
    }
}

}  // namespace
}  // namespace mortise::feti
