#include "qp/condensed_newton.hpp"

#include <algorithm>
#include <utility>

#include "dense_system.hpp"
#include "state_search.hpp"

namespace mortise::qp {

namespace {

constexpr double dependent = 1e-10;  // of what a row gives way with all others: less alone comes of rounding
constexpr double apart = 1e-6;       // compliance of its own that such a row is given, over that,
constexpr double told_apart = 1e-4;  // and that it is taken to have, so that rounding of what it feels is no force

using Eigen::MatrixXd;
using Eigen::VectorXd;

// That of W^-1 = L^-T L^-1: the squares of the columns of L^-1, which are zero above the diagonal.
VectorXd diagonal_of_inverse(const Eigen::LLT<MatrixXd>& factor)
{
  const auto& l = factor.matrixLLT();
  VectorXd result(l.rows());
  in_pieces(l.rows(), [&](Eigen::Index first, Eigen::Index count) {
    const Eigen::Index rest = l.rows() - first;
    MatrixXd columns = MatrixXd::Identity(rest, count);
    l.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>().solveInPlace(columns);
    result.segment(first, count) = columns.colwise().squaredNorm();
  });
  return result;
}

// Rows that depend on each other, as those of two contacts along the edge that a body has in a corner: how a force is shared out
// between them is open, and rounding alone would tell it, and states. A little compliance of their own shares it out evenly.
// `own`: what each gives way alone. Returns which they are.
std::vector<Eigen::Index> separate(MatrixXd& w, const VectorXd& own)
{
  auto diagonal = w.diagonal();
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (own[i] > dependent * diagonal[i]) continue;
    diagonal[i] *= 1 + apart;
    rows.push_back(i);
  }
  return rows;
}

}  // namespace

CondensedNewton::CondensedNewton(MatrixXd a, MatrixXd g, MatrixXd c, const FeasibleSet& set) : constrained_(set.constrained())
{
  std::vector<char> taken(static_cast<std::size_t>(a.rows()), 0);
  for (const Local i : constrained_) taken[static_cast<std::size_t>(i)] = 1;
  for (Local i = 0; i < static_cast<Local>(a.rows()); ++i)
    if (!taken[static_cast<std::size_t>(i)]) others_.push_back(i);
  const MatrixXd between = a(others_, constrained_), g_free = g(Eigen::all, others_);
  factorize_free(a(others_, others_));
  coupling_ = qp::solve(free_, between);
  motion_ = qp::solve(free_, g_free.transpose());
  matrices_.w = a(constrained_, constrained_);
  in_pieces(matrices_.w.cols(), [&](Eigen::Index first, Eigen::Index count) {
    matrices_.w.middleCols(first, count).noalias() -= between.transpose() * coupling_.middleCols(first, count);
  });
  matrices_.w = 0.5 * (matrices_.w + matrices_.w.transpose()).eval();
  matrices_.h = g(Eigen::all, constrained_) - g_free * coupling_;
  matrices_.c = std::move(c);
  matrices_.c.noalias() += g_free * motion_;
  measure();
  const auto dependent_rows = separate(matrices_.w, matrices_.own);
  if (dependent_rows.empty()) return;
  separated_ = true;
  measure();
  for (const auto i : dependent_rows) matrices_.own[i] = std::max(matrices_.own[i], told_apart * matrices_.w(i, i));
}

// What each point gives way alone.
void CondensedNewton::measure()
{
  contact_ = factorize(matrices_.w);
  matrices_.own = diagonal_of_inverse(contact_).cwiseInverse();
}

// The same of rows without a constraint, as those of bonds round a common edge. The last of those that depend on each other has
// no pivot of its own.
void CondensedNewton::factorize_free(MatrixXd a)
{
  constexpr double no_pivot = 10 * dependent;
  free_ = factorize(a);
  const VectorXd pivots = free_.matrixLLT().diagonal().cwiseAbs2();
  if ((pivots.array() > no_pivot * a.diagonal().array()).all()) return;
  separated_ = !separate(a, diagonal_of_inverse(free_).cwiseInverse()).empty();
  if (separated_) free_ = factorize(a);
}

VectorXd CondensedNewton::inverse_times(const VectorXd& r) const
{
  VectorXd x(r.size());
  const VectorXd contact = contact_.solve(VectorXd(r(constrained_) - coupling_.transpose() * r(others_)));
  x(constrained_) = contact;
  x(others_) = free_.solve(VectorXd(r(others_))) - coupling_ * contact;
  return x;
}

CondensedNewton::Result CondensedNewton::solve(const VectorXd& b, const VectorXd& e, const FeasibleSet& set,
                                               const Result* near) const
{
  StateSearch search({matrices_, contact_, set.compact(), b(constrained_) - coupling_.transpose() * b(others_),
                      e - motion_.transpose() * b(others_)});
  const auto go_on = [&] { return search.from(near->x(constrained_), near->nu, near->reaction(constrained_), near->converged); };
  const bool converged = near ? go_on() : search.from_anywhere();
  if (converged) search.polish();
  Result point = search.point();
  point.converged = converged;
  const VectorXd contact = point.x;
  point.x.resize(b.size());
  point.x(constrained_) = contact;
  point.x(others_) = free_.solve(VectorXd(b(others_))) - coupling_ * contact - motion_ * point.nu;
  point.reaction = VectorXd::Zero(b.size());
  point.reaction(constrained_) = search.reaction();
  return point;
}

}  // namespace mortise::qp
