// Factors of one guess lead to the solution of another, whose states differ at some points.
#include "../src/move_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace mortise::qp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index all_points = 700;  // with a normal and one tangential unknown each

MatrixXd normal_numbers(Index rows, Index columns, unsigned seed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&](Index, Index) { return normal(generator); });
}

// Points on a half plane: what they give way falls off with their distance; three motions.
CondensedMatrices half_plane()
{
  constexpr Index n = 2 * all_points;
  CondensedMatrices matrices;
  matrices.w.resize(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double apart = std::abs(static_cast<double>(i / 2 - j / 2));
      matrices.w(i, j) = (i % 2 == j % 2 ? 1.0 : 0.2) * std::exp(-0.02 * apart) + (i == j ? 0.02 : 0.0);
    }
  matrices.h = normal_numbers(3, n, 1);
  matrices.c = MatrixXd::Zero(3, 3);
  matrices.own = matrices.w.llt().solve(MatrixXd::Identity(n, n)).diagonal().cwiseInverse();
  return matrices;
}

// Points up to `closed` press, those from `sticking` on of them slip with a coefficient of 0.3.
std::vector<Move> pressed_moves(Index closed, Index sticking)
{
  std::vector<Move> all;
  for (Index i = 0; i < closed; ++i) {
    const auto at = static_cast<Local>(2 * i);
    if (i < sticking) {
      all.push_back({{at, -1, -1}, {1, 0, 0}, {1, 0, 0}, 0});
      all.push_back({{at + 1, -1, -1}, {1, 0, 0}, {1, 0, 0}, 0});
    } else {
      all.push_back({{at, at + 1, -1}, {1, 0.3, 0}, {1, 0, 0}, 0});
    }
  }
  return all;
}

double lack_of(const MoveProblem& problem, const VectorXd& r, const VectorXd& l, const MoveFactor::Solution& at)
{
  const VectorXd first = problem.matrix() * at.amount + problem.push() * at.nu - r;
  const VectorXd second = problem.motion() * at.amount - problem.matrices().c * at.nu - l;
  return first.norm() / r.norm() + second.norm() / l.norm();
}

TEST(MoveFactor, LeadsToTheSolutionOfAnotherGuess)
{
  const auto matrices = half_plane();
  const VectorXd hard = VectorXd::Zero(2 * all_points), scale = VectorXd::Ones(3);
  const MoveProblem first(matrices, hard, pressed_moves(600, 300), false);
  const MoveFactor factor(first);
  constexpr int steps = 24;  // GMRES ends at the rank of what has changed: at most three unknowns at each of six points, and some
  for (const auto& [closed, sticking] : {std::pair<Index, Index>{600, 300}, {606, 303}, {596, 298}, {604, 296}}) {
    const MoveProblem next(matrices, hard, pressed_moves(closed, sticking), false);
    const VectorXd r = normal_numbers(next.size(), 1, 2), l = normal_numbers(3, 1, 3);
    MoveFactor::Solution at{VectorXd::Zero(next.size()), VectorXd::Zero(3)};
    for (const double lack : {1e-3, 1e-6, 1e-10}) {  // each time nearer by four figures
      const auto found = factor.iterate(next, r, l, scale, at, steps);
      ASSERT_TRUE(found.has_value()) << closed << ", " << sticking << ", " << lack;
      at = *found;
      EXPECT_LT(lack_of(next, r, l, at), lack) << closed << ", " << sticking;
    }
  }
}

TEST(MoveFactor, SaysThatItDoesNotLeadFarther)
{
  const auto matrices = half_plane();
  const VectorXd hard = VectorXd::Zero(2 * all_points), scale = VectorXd::Ones(3);
  const MoveFactor factor(MoveProblem(matrices, hard, pressed_moves(300, 300), true));
  const MoveProblem far(matrices, hard, pressed_moves(700, 0), false);
  const VectorXd r = normal_numbers(far.size(), 1, 2), l = normal_numbers(3, 1, 3);
  const auto found = factor.iterate(far, r, l, scale, {VectorXd::Zero(far.size()), VectorXd::Zero(3)}, 24);
  if (found) {
    EXPECT_LT(lack_of(far, r, l, *found), 1e-3);
  }
  auto loose = matrices;  // a motion that no point feels
  loose.h.row(1).setZero();
  const MoveProblem free(loose, hard, pressed_moves(300, 300), true);
  EXPECT_FALSE(factor.iterate(free, VectorXd::Ones(free.size()), l, scale, {VectorXd::Zero(free.size()), VectorXd::Zero(3)}, 24));
}

}  // namespace
}  // namespace mortise::qp
