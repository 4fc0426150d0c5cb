// What residuals claim of errors, against the errors.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "qp/error_estimate.hpp"
#include "qp/face_newton.hpp"
#include "random_programme.hpp"

namespace mortise::qp {
namespace {

// The inverse of a dense matrix: the energy of a residual is exact, but for what G and constraints take of it.
class Inverse : public ActiveSetPreconditioner {
 public:
  Inverse(const Eigen::MatrixXd& a, Teuchos::RCP<const Map> map) : inverse_(a.inverse(), map, world()) {}
  void fix(std::span<const Local>, std::span<const SlipDirection>) override {}
  Teuchos::RCP<const Map> getDomainMap() const override { return inverse_.getDomainMap(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return inverse_.getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override
  {
    inverse_.apply(x, y, mode, alpha, beta);
  }

 private:
  DenseOperator inverse_;
};

TEST(ErrorBound, IsOneAtEveryPoint)
{
  RandomProgramme programme;
  Inverse inverse(programme.dense, programme.map);
  const Eigen::VectorXd exact = programme.reference();
  const double norm = programme.by_face_newton({1e-2}).hessian_norm;
  Projector projector(programme.equality, programme.set);
  for (const double distance : {1.0, 1e-1, 1e-2, 1e-4, 1e-6})
    for (int trial = 0; trial < 10; ++trial) {
      const Vector near = local_part(exact + distance * programme.random(RandomProgramme::n, 1), programme.map);
      Solution point(projector(near, programme.right.e, programme.set).point, Vector(programme.map), {});
      programme.hessian.apply(point.x, point.gradient);
      point.gradient.update(-1, programme.right.b, 1);
      point.hessian_norm = norm;
      const double error = programme.distance(point.x, exact), bound = error_bound(programme.problem, point, &inverse);
      EXPECT_GE(bound, (1 - 1e-5) * error) << distance;
    }
}

TEST(ErrorBound, IsNotFarAboveTheErrorWhereSolversStop)
{
  RandomProgramme programme;
  Inverse inverse(programme.dense, programme.map);
  const Eigen::VectorXd exact = programme.reference();
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
    const Solution solution = programme.by_face_newton({tolerance}, &inverse);
    const double error = programme.distance(solution.x, exact);
    EXPECT_GE(solution.error, (1 - 1e-5) * error) << tolerance;
    EXPECT_LE(solution.error, 5 * error + 1e-8) << tolerance;
  }
}

// A small residual beside a large error is no solution where the goal knows how large solutions are.
TEST(ErrorBound, SmallResidualsAreBelievedWithSmallErrorsAlone)
{
  RandomProgramme programme;
  const auto norm = [](double value) { return [value](const Vector&, const Eigen::VectorXd&) { return value; }; };
  const Vector x(programme.map);
  Goal goal{1e-4};
  EXPECT_TRUE(believable(1.0, 0, x, {}, goal));  // it does not know
  goal.energy_norm = norm(50);
  EXPECT_TRUE(believable(0.4, 0, x, {}, goal));
  EXPECT_FALSE(believable(0.6, 0, x, {}, goal));
  EXPECT_TRUE(believable(0.6, 0.7, x, {}, goal));  // rounding
  goal.residual = 1e-6;
  EXPECT_TRUE(believable(0.004, 0, x, {}, goal));
  EXPECT_FALSE(believable(0.02, 0, x, {}, goal));
  EXPECT_TRUE(believable(0.02, 0, x, {}, goal, true));  // nothing makes it smaller

  // A solution that is a million times smaller than its problem asks for more products, or it is none.
  Goal loose{1e-3}, strict{1e-3};
  strict.energy_norm = norm(1e-3);
  const Solution first = programme.by_face_newton(loose);
  const Solution second = programme.by_face_newton(strict);
  EXPECT_TRUE(first.converged);
  EXPECT_TRUE(second.converged);
  const Eigen::VectorXd exact = programme.reference();
  EXPECT_GT(programme.distance(first.x, exact), strict.credible() * 1e-3);
  EXPECT_LE(programme.distance(second.x, exact), strict.credible() * 1e-3);
}

}  // namespace
}  // namespace mortise::qp
