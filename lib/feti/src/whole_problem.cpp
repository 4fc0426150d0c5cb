#include "whole_problem.hpp"

#include "base/submatrix.hpp"

namespace mortise::feti {

using Eigen::Index;
using Eigen::VectorXd;

WholeProblem::WholeProblem(SparseMatrix stiffness, Rows rows, VectorXd compliance, const qp::FeasibleSet& set)
    : stiffness_(std::move(stiffness)), rows_(std::move(rows)), compliance_(std::move(compliance))
{
  choose_supports(set);
  newton_ = std::make_unique<qp::SparseNewton>(reduced(stiffness_));
}

// Rows without a constraint that hold one unknown, an unknown once.
void WholeProblem::choose_supports(const qp::FeasibleSet& set)
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

// Over the unknowns and rows that are left.
qp::SparseMatrices WholeProblem::reduced(const SparseMatrix& stiffness) const
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

qp::FeasibleSet WholeProblem::reduced(const qp::FeasibleSet& set) const
{
  const auto number = [&](Local row) { return row < 0 ? -1 : number_[static_cast<std::size_t>(row)]; };
  std::vector<qp::Bound> bounds(set.bounds().begin(), set.bounds().end());
  std::vector<qp::Disc> discs(set.discs().begin(), set.discs().end());
  for (auto& bound : bounds) bound.index = number(bound.index);
  for (auto& disc : discs) {
    disc.index = {number(disc.index[0]), number(disc.index[1])};
    disc.normal = number(disc.normal);
  }
  return {std::move(bounds), std::move(discs)};
}

// The unknowns that supports hold, over all unknowns, where their rows are to see these bounds.
VectorXd WholeProblem::held(const VectorXd& bounds) const
{
  VectorXd u = VectorXd::Zero(rows_.cols());
  for (const auto& support : supports_) u[support.unknown] = bounds[support.row] / support.coefficient;
  return u;
}

// The multipliers of all rows from those of the rows that are kept, where supports take up what `forces` lack.
VectorXd WholeProblem::complete(const VectorXd& kept, const VectorXd& forces) const
{
  VectorXd x = VectorXd::Zero(rows_.rows());
  x(kept_) = kept;
  const VectorXd left = forces - rows_.transpose() * x;
  for (const auto& support : supports_) x[support.row] = left[support.unknown] / support.coefficient;
  return x;
}

WholeProblem::Solution WholeProblem::solve(const VectorXd& f, const VectorXd& c, const qp::FeasibleSet& set, const VectorXd* near)
{
  VectorXd u = held(c);
  VectorXd load = f;
  load -= stiffness_.selfadjointView<Eigen::Lower>() * u;
  const VectorXd gap = c - rows_ * u;
  qp::CondensedNewton::Point from;
  if (last_.size() == 0) near = nullptr;
  if (near) from = {(*near)(kept_), last_(free_), true, 0, last_reaction_};
  const auto found = newton_->solve(load(free_), gap(kept_), reduced(set), near ? &from : nullptr);
  u(free_) = found.nu;
  load = f;
  load -= stiffness_.selfadjointView<Eigen::Lower>() * u;
  Solution result{complete(found.x, load), u, VectorXd::Zero(rows_.rows()), found.converged, found.steps, found.settled};
  for (const Local i : set.constrained()) result.reaction[i] = found.reaction[number_[static_cast<std::size_t>(i)]];
  last_ = std::move(u);
  last_reaction_ = found.reaction;
  return result;
}

void WholeProblem::make_inverse(SparseMatrix regularised)
{
  regularised_ = std::move(regularised);
  inverse_ = std::make_unique<qp::SparseInverse>(reduced(regularised_));
}

VectorXd WholeProblem::inverse_times(const VectorXd& r) const
{
  VectorXd u = held(r);
  VectorXd force = VectorXd::Zero(u.size());
  force -= regularised_.selfadjointView<Eigen::Lower>() * u;
  const VectorXd jump = r - rows_ * u;
  const auto found = inverse_->solve(jump(kept_), force(free_));
  u(free_) = found.u;
  force = regularised_.selfadjointView<Eigen::Lower>() * u;
  return complete(found.x, force);
}

}  // namespace mortise::feti
