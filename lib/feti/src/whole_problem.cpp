#include "whole_problem.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "base/submatrix.hpp"

namespace mortise::feti {

using Eigen::Index;
using Eigen::VectorXd;

SupportElimination::SupportElimination(Rows rows, VectorXd compliance, const qp::FeasibleSet& set)
    : rows_(std::move(rows)), compliance_(std::move(compliance))
{
  std::vector<char> constrained(static_cast<std::size_t>(rows_.rows()), 0), taken(static_cast<std::size_t>(rows_.cols()), 0);
  for (const Local i : set.constrained()) constrained[static_cast<std::size_t>(i)] = 1;
  for (int row = 0; row < rows_.rows(); ++row) {
    const Rows::InnerIterator first(rows_, row);
    const bool single = rows_.outerIndexPtr()[row + 1] == rows_.outerIndexPtr()[row] + 1;
    if (single && constrained[static_cast<std::size_t>(row)] == 0 && !(compliance_[row] > 0) &&
        taken[static_cast<std::size_t>(first.col())]++ == 0) {
      supports_.push_back({row, static_cast<int>(first.col()), first.value()});
      number_.push_back(-1);
      continue;
    }
    number_.push_back(static_cast<Local>(kept_.size()));
    kept_.push_back(row);
  }
  for (int i = 0; i < rows_.cols(); ++i)
    if (taken[static_cast<std::size_t>(i)] == 0) free_.push_back(i);
}

qp::SparseMatrices SupportElimination::reduced(const SparseMatrix& stiffness) const
{
  std::vector<int> place(static_cast<std::size_t>(rows_.cols()), -1);
  for (std::size_t i = 0; i < free_.size(); ++i) place[static_cast<std::size_t>(free_[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < kept_.size(); ++i)
    for (Rows::InnerIterator it(rows_, kept_[i]); it; ++it)
      if (const int column = place[static_cast<std::size_t>(it.col())]; column >= 0)
        entries.emplace_back(static_cast<int>(i), column, it.value());
  qp::SparseMatrices result;
  result.k = submatrix(stiffness, free_, free_, true);
  result.b.resize(static_cast<Index>(kept_.size()), static_cast<Index>(free_.size()));
  result.b.setFromTriplets(entries.begin(), entries.end());
  result.s = compliance_(kept_);
  return result;
}

qp::FeasibleSet SupportElimination::reduced(const qp::FeasibleSet& set) const
{
  const auto number_or_none = [&](Local row) { return row < 0 ? -1 : number(row); };
  std::vector<qp::Bound> bounds(set.bounds().begin(), set.bounds().end());
  std::vector<qp::Disc> discs(set.discs().begin(), set.discs().end());
  for (auto& bound : bounds) bound.index = number_or_none(bound.index);
  for (auto& disc : discs) {
    disc.index = {number_or_none(disc.index[0]), number_or_none(disc.index[1])};
    disc.normal = number_or_none(disc.normal);
  }
  return {std::move(bounds), std::move(discs)};
}

VectorXd SupportElimination::prescribed(const VectorXd& bounds) const
{
  VectorXd u = VectorXd::Zero(rows_.cols());
  for (const auto& support : supports_) u[support.unknown] = bounds[support.row] / support.coefficient;
  return u;
}

VectorXd SupportElimination::complete(const VectorXd& multipliers, ExtendedVector forces) const
{
  VectorXd x = VectorXd::Zero(rows_.rows());
  x(kept_) = multipliers;
  subtract_transposed_product(rows_, x, forces);
  for (const auto& support : supports_) x[support.row] = static_cast<double>(forces[support.unknown]) / support.coefficient;
  return x;
}

Gauges::Gauges(SupportElimination::Rows& rows, Motions motions) : motions_(std::move(motions))
{
  const Index count = motions_.cols(), first = rows.rows() - count;
  gauges_ = rows.bottomRows(count);
  work_ = Eigen::MatrixXd(gauges_ * motions_);
  pinned_work_.resize(count, count);
  rows.prune([&](Index row, Index, double) { return row < first; });
  std::vector<std::pair<int, Eigen::SparseVector<double>>> eliminated;  // with the unknown that is held
  for (Index k = 0; k < count; ++k) {
    Eigen::SparseVector<double> left = motions_.col(k);
    for (const auto& [pin, before] : eliminated)
      if (const double part = left.coeff(pin); part != 0) left -= part / before.coeff(pin) * before;
    int pin = 0;
    double largest = 0;
    for (Eigen::SparseVector<double>::InnerIterator it(left); it; ++it)
      if (std::abs(it.value()) > largest) largest = std::abs(it.value()), pin = static_cast<int>(it.index());
    const double entry = work_(k, k) / motions_.coeff(pin, static_cast<int>(k));
    rows.coeffRef(static_cast<int>(first + k), pin) = entry;
    for (Index j = 0; j < count; ++j) pinned_work_(k, j) = entry * motions_.coeff(pin, static_cast<int>(j));
    eliminated.emplace_back(pin, std::move(left));
  }
  rows.makeCompressed();
}

void Gauges::restore(const VectorXd& c, VectorXd& x, VectorXd& u) const
{
  const Index count = motions_.cols();
  if (count == 0) return;
  const VectorXd lacking = c.tail(count) - gauges_ * u;
  u += motions_ * work_.partialPivLu().solve(lacking);
  x.tail(count) = work_.transpose().partialPivLu().solve(pinned_work_.transpose() * x.tail(count));
}

WholeProblem::WholeProblem(SparseMatrix stiffness, const SupportElimination& elimination, bool patient)
    : stiffness_(std::move(stiffness)), elimination_(elimination), newton_(elimination.reduced(stiffness_), patient)
{
}

WholeProblem::Solution WholeProblem::solve(const VectorXd& f, const VectorXd& c, const qp::FeasibleSet& set, const Start* near)
{
  const auto &kept = elimination_.kept(), &free = elimination_.free();
  VectorXd u = elimination_.prescribed(c);
  VectorXd load = f;
  load -= stiffness_.selfadjointView<Eigen::Lower>() * u;
  const VectorXd gap = c - elimination_.rows() * u;
  qp::CondensedNewton::Result from;
  if (near && (last_.size() == 0 || !near->solved))
    from = {near->x(kept), u(free), near->solved, 0, near->reaction(kept)};
  else if (near)
    from = {near->x(kept), last_(free), true, 0, last_reaction_};
  const auto found = newton_.solve(load(free), gap(kept), elimination_.reduced(set), near ? &from : nullptr);
  u(free) = found.nu;
  ExtendedVector exact_u = u.cast<long double>(), left = f.cast<long double>();
  if (found.nu_rest.size() > 0) exact_u(free) += found.nu_rest.cast<long double>();
  subtract_product(stiffness_, exact_u, left);
  Solution result{
      elimination_.complete(found.x, std::move(left)), u, VectorXd::Zero(c.size()), found.converged, found.steps, found.settled};
  for (const Local i : set.constrained()) result.reaction[i] = found.reaction[elimination_.number(i)];
  last_ = std::move(u);
  last_reaction_ = found.reaction;
  return result;
}

WholeInverse::WholeInverse(SparseMatrix regularised, const SupportElimination& elimination, bool slender)
    : regularised_(std::move(regularised)), elimination_(elimination), inverse_(elimination.reduced(regularised_), slender)
{
}

VectorXd WholeInverse::times(const VectorXd& r) const
{
  const auto& free = elimination_.free();
  ExtendedVector u = elimination_.prescribed(r).cast<long double>(), force = ExtendedVector::Zero(u.size());
  subtract_product(regularised_, u, force);
  const VectorXd jump = r - elimination_.rows() * u.cast<double>();
  const auto found = inverse_.solve(jump(elimination_.kept()), force(free).cast<double>());
  u(free) = found.u;
  force.setZero();
  subtract_product(regularised_, u, force);
  return elimination_.complete(found.x, -force);
}

}  // namespace mortise::feti
