// A string over an obstacle, without equalities (MPRGP alone) and with its mean height prescribed; and a random programme with
// discs. Every solution is judged by its KKT residuals.
#include <gtest/gtest.h>

#include "qp/face_newton.hpp"
#include "qp/smalse.hpp"
#include "random_programme.hpp"

namespace mortise::qp {
namespace {

Eigen::MatrixXd second_difference(int n)
{
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    a(i, i) = 2;
    if (i > 0) a(i, i - 1) = a(i - 1, i) = -1;
  }
  return a;
}

// Both algorithms under one name.
using Algorithm = Solution (*)(const Problem&, const std::optional<Solution>& start, double tolerance);

Solution by_smalse(const Problem& problem, const std::optional<Solution>& start, double tolerance)
{
  return smalse(problem, start, tolerance, {});
}

Solution by_face_newton(const Problem& problem, const std::optional<Solution>& start, double tolerance)
{
  const Programme programme{problem.hessian, problem.equality, problem.set};
  return FaceNewton(programme, nullptr).solve(problem.right, problem.set.radii(), nullptr, start, {tolerance, {}}, {});
}

class Obstacle : public testing::TestWithParam<Algorithm> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Obstacle, testing::Values(by_smalse, by_face_newton));

TEST_P(Obstacle, StringIsSolvedToItsKktConditions)
{
  constexpr int n = 60;
  const auto map = even_map(n, world());
  const DenseOperator a(second_difference(n), map, world());
  const RightHandSide right{local_part(Eigen::VectorXd::Constant(n, -0.002), map), {}};
  std::vector<Bound> bounds;
  for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i) bounds.push_back({i, -0.4});
  const FeasibleSet set(bounds, {});
  const EqualityConstraint none(SparseMatrix(0, static_cast<Eigen::Index>(bounds.size())), world());
  Hessian hessian(a, 2000);
  const Problem problem({hessian, none, set}, right, set);
  const Solution solution = GetParam()(problem, {}, 1e-9);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(kkt(solution, problem), 1e-9);
  const Eigen::VectorXd x = gathered(solution.x, world());
  EXPECT_NEAR(x.minCoeff(), -0.4, 1e-12);
  // Where it hangs free between the wall at 0 and the obstacle it is a parabola of the load's curvature.
  EXPECT_NEAR(x[2] - 2 * x[1] + x[0], 0.002, 1e-8);
  EXPECT_GT((x.array() == -0.4).count(), 10);
}

TEST_P(Obstacle, EqualityAndDiscs)
{
  RandomProgramme programme;
  auto& [hessian, equality, right, set] = programme.problem;
  const Solution solution = GetParam()(programme.problem, {}, 1e-10);
  ASSERT_TRUE(solution.feasible);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(equality.norm(equality.apply(solution.x) - right.e), 1e-10);
  EXPECT_LT(kkt(solution, programme.problem), 1e-7);

  // A warm start from the solution must end at once and at the same point.
  const int before = hessian.count();
  const Solution again = GetParam()(programme.problem, solution, 1e-6);
  EXPECT_LT(hessian.count() - before, 8);
  const Eigen::VectorXd x = gathered(solution.x, world());
  EXPECT_LT((gathered(again.x, world()) - x).norm(), 1e-5 * x.norm());
}

TEST(FaceNewton, StopsAtTheAllowedError)
{
  RandomProgramme programme;
  const Eigen::VectorXd exact = programme.reference();
  const double norm = programme.distance(Vector(programme.map), exact);
  for (const auto& [part, most] : {std::pair(1e-1, 15), std::pair(1e-2, 19), std::pair(1e-4, 23)}) {
    const double allowed = part * norm;
    int asked = 0;
    const Goal goal{0, [&](const Vector&, const Eigen::VectorXd&) {
                      ++asked;
                      return allowed;
                    }};
    const int before = programme.hessian.count();
    const Solution solution = programme.by_face_newton(goal);
    EXPECT_TRUE(solution.converged);
    EXPECT_GE(asked, 1);
    EXPECT_LE(programme.distance(solution.x, exact), allowed);
    EXPECT_LE(programme.hessian.count() - before, most);
  }
}

// An error that is small enough is none while what the multipliers belong to is torn: here until it is 100 times smaller.
TEST(FaceNewton, GoesOnWhileThePrimalSolutionIsIncompatible)
{
  RandomProgramme programme;
  const Eigen::VectorXd exact = programme.reference();
  const double norm = programme.distance(Vector(programme.map), exact);
  const double allowed = 1e-1 * norm;
  Goal goal{0, [&](const Vector&, const Eigen::VectorXd&) { return allowed; }};
  const Solution loose = programme.by_face_newton(goal);
  ASSERT_GT(programme.distance(loose.x, exact), 1e-2 * allowed);
  goal.incompatibility = [&](const Vector& x, const Eigen::VectorXd&) {
    return programme.distance(x, exact) < 1e-2 * allowed ? 0.0 : 1.0;
  };
  const Solution tight = programme.by_face_newton(goal);
  EXPECT_TRUE(tight.converged);
  EXPECT_LT(programme.distance(tight.x, exact), 1e-2 * allowed);
}

}  // namespace
}  // namespace mortise::qp
