// A random quadratic programme with contact nodes, and what tells whether it is solved.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "dense_operator.hpp"
#include "qp/face_newton.hpp"
#include "testing/quiet.hpp"

namespace mortise::qp {

// ||x - P_Omega(x - (g + G'nu))||, zero exactly at a solution, with g = A x - b computed anew. One product.
inline double kkt(const Solution& solution, const Problem& problem)
{
  Vector moved(solution.x, Teuchos::Copy);
  Vector gradient(solution.x.getMap());
  problem.hessian.apply(solution.x, gradient);
  gradient.update(-1, problem.right.b, 1);
  if (problem.equality.size() > 0) problem.equality.add_transpose(1, solution.nu, gradient);
  moved.update(-1, gradient, 1);
  problem.set.project(view(moved));
  moved.update(-1, solution.x, 1);
  return moved.norm2();
}

// A random programme with five equalities, bounds and discs; a point inside makes it feasible.
struct RandomProgramme {
  explicit RandomProgramme(Eigen::Index equalities = 5) : count(equalities) {}

  static constexpr int n = 48;
  static constexpr double radius = 0.6;  // of discs
  std::mt19937 generator{7};
  std::normal_distribution<double> normal;

  Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns)
  {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index, Eigen::Index) { return normal(generator); });
  }
  static Eigen::MatrixXd definite(const Eigen::MatrixXd& root)
  {
    return root * root.transpose() / n + 0.05 * Eigen::MatrixXd::Identity(n, n);
  }
  // In blocks of three: a bound and a disc; blocks never straddle two ranks.
  static Teuchos::RCP<const Map> blocks_of_three()
  {
    const Local blocks = n / 3 / world().size() + (world().rank() < n / 3 % world().size() ? 1 : 0);
    return Teuchos::rcp(new Map(n, static_cast<std::size_t>(3 * blocks), 0, teuchos(world())));
  }
  static FeasibleSet bounds_and_discs(Local size)
  {
    std::vector<Bound> bounds;
    std::vector<Disc> discs;
    for (Local i = 0; i < size; i += 3) {
      bounds.push_back({i, 0});
      discs.push_back({{i + 1, i + 2}, radius, {0, 0}});
      discs.back().normal = i;
    }
    return {bounds, discs};
  }

  Eigen::Index count;
  Eigen::MatrixXd dense = definite(random(n, n));
  Eigen::MatrixXd g = random(count, n);
  Eigen::VectorXd inside = 0.1 * random(n, 1).cwiseAbs();
  Teuchos::RCP<const Map> map = blocks_of_three();
  FeasibleSet set = bounds_and_discs(static_cast<Local>(map->getNodeNumElements()));
  DenseOperator a{dense, map, world()};
  EqualityConstraint equality{local_columns(g, *map), world()};
  Hessian hessian{a, 20000};
  RightHandSide right{local_part(random(n, 1), map), g* inside};
  Programme programme{hessian, equality, set};
  Problem problem{programme, right, set};

  // With radii as they are given above. Collective.
  Solution by_face_newton(const Goal& goal, ActiveSetPreconditioner* preconditioner = nullptr) const
  {
    return FaceNewton(programme, preconditioner).solve(right, set.radii(), nullptr, {}, goal, {});
  }

  // The solution with radii as they are given above, of whole matrices, by alternating directions [Boyd et al., Found. Trends
  // Mach. Learn. 3 (2011)]: x solves the equations, z lies in Omega. Nothing of it comes from the code under test. Collective.
  Eigen::VectorXd reference() const
  {
    constexpr double r = 0.5;
    const Eigen::Index m = g.rows();
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n + m, n + m);
    k.topLeftCorner(n, n) = dense + r * Eigen::MatrixXd::Identity(n, n);
    k.topRightCorner(n, m) = g.transpose();
    k.bottomLeftCorner(m, n) = g;
    const Eigen::PartialPivLU<Eigen::MatrixXd> factor(k);
    const Eigen::VectorXd linear = gathered(right.b, world());
    Eigen::VectorXd right(n + m), z = Eigen::VectorXd::Zero(n), y = z;
    right.tail(m) = g * inside;
    double off = 1;
    for (int i = 0; i < 100000 && off > 1e-14; ++i) {
      right.head(n) = linear + r * (z - y);
      const Eigen::VectorXd x = factor.solve(right).head(n), before = z;
      z = x + y;
      for (Eigen::Index p = 0; p < n; p += 3) {
        z[p] = std::max(z[p], 0.0);
        z.segment(p + 1, 2) /= std::max(1.0, z.segment(p + 1, 2).norm() / radius);
      }
      y += x - z;
      off = (x - z).norm() + (z - before).norm();
    }
    EXPECT_LE(off, 1e-14);
    return z;
  }
  // ||x - other||_A
  double distance(const Vector& x, const Eigen::VectorXd& other) const
  {
    const Eigen::VectorXd e = gathered(x, world()) - other;
    return std::sqrt(e.dot(dense * e));
  }
};

}  // namespace mortise::qp
