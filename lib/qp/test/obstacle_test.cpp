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
  return FaceNewton(problem, nullptr).solve(start, {tolerance, {}}, nullptr, {});
}

class Obstacle : public testing::TestWithParam<Algorithm> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Obstacle, testing::Values(by_smalse, by_face_newton));

TEST_P(Obstacle, StringIsSolvedToItsKktConditions)
{
  constexpr int n = 60;
  const auto map = even_map(n, world());
  const DenseOperator a(second_difference(n), map, world());
  const Vector b = local_part(Eigen::VectorXd::Constant(n, -0.002), map);
  std::vector<Bound> bounds;
  for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i) bounds.push_back({i, -0.4});
  const FeasibleSet set(bounds, {});
  const EqualityConstraint none(SparseMatrix(0, static_cast<Eigen::Index>(bounds.size())), {}, world());
  Hessian hessian(a, 2000);
  const Problem problem{hessian, b, none, set};
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
  auto& [hessian, b, equality, set, driven] = programme.problem;
  const Solution solution = GetParam()(programme.problem, {}, 1e-10);
  ASSERT_TRUE(solution.feasible);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(equality.norm(equality.apply(solution.x) - equality.right_side()), 1e-10);
  EXPECT_LT(kkt(solution, programme.problem), 1e-7);

  // A warm start from the solution must end at once and at the same point.
  const int before = hessian.count();
  const Solution again = GetParam()(programme.problem, solution, 1e-6);
  EXPECT_LT(hessian.count() - before, 8);
  EXPECT_LT((gathered(again.x, world()) - gathered(solution.x, world())).norm(), 1e-5);
}

TEST(FaceNewton, StopsAtTheAllowedError)
{
  RandomProgramme programme;
  const Eigen::VectorXd exact = gathered(FaceNewton(programme.problem, nullptr).solve({}, {1e-12, {}}, nullptr, {}).x, world());
  const auto norm = [&](const Eigen::VectorXd& x) { return std::sqrt(x.dot(programme.dense * x)); };
  int products = 0;
  for (const double part : {1e-1, 1e-2, 1e-4}) {
    const double allowed = part * norm(exact);
    int asked = 0;
    const Goal goal{0, [&](const Vector&, const Eigen::VectorXd&) {
                      ++asked;
                      return allowed;
                    }};
    const int before = programme.hessian.count();
    const Solution solution = FaceNewton(programme.problem, nullptr).solve({}, goal, nullptr, {});
    EXPECT_TRUE(solution.converged);
    EXPECT_LE(solution.error, allowed);
    EXPECT_GE(asked, 1);
    EXPECT_LE(norm(gathered(solution.x, world()) - exact), 2 * allowed);
    EXPECT_GE(programme.hessian.count() - before, products);  // more of them for more
    products = programme.hessian.count() - before;
  }
}

// An error that is small enough is none while what the multipliers belong to is torn: here until it is 100 times smaller.
TEST(FaceNewton, GoesOnWhileThePrimalSolutionIsIncompatible)
{
  RandomProgramme programme;
  const Eigen::VectorXd exact = gathered(FaceNewton(programme.problem, nullptr).solve({}, {1e-12, {}}, nullptr, {}).x, world());
  const auto norm = [&](const Eigen::VectorXd& x) { return std::sqrt(x.dot(programme.dense * x)); };
  const double allowed = 1e-1 * norm(exact);
  Goal goal{0, [&](const Vector&, const Eigen::VectorXd&) { return allowed; }};
  const Solution loose = FaceNewton(programme.problem, nullptr).solve({}, goal, nullptr, {});
  ASSERT_GT(norm(gathered(loose.x, world()) - exact), 1e-2 * allowed);
  goal.incompatibility = [&](const Vector& x, const Eigen::VectorXd&) {
    return norm(gathered(x, world()) - exact) < 1e-2 * allowed ? 0.0 : 1.0;
  };
  const Solution tight = FaceNewton(programme.problem, nullptr).solve({}, goal, nullptr, {});
  EXPECT_TRUE(tight.converged);
  EXPECT_LT(norm(gathered(tight.x, world()) - exact), 1e-2 * allowed);
}

}  // namespace
}  // namespace mortise::qp
