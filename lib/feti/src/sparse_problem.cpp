#include "feti/sparse_problem.hpp"

#include <algorithm>
#include <numeric>

#include "base/submatrix.hpp"
#include "feti/explicit_problem.hpp"

namespace mortise::feti {

namespace {

constexpr double dense_guesses = 8;      // of a direct solution with dense matrices
constexpr double sparse_problems = 30;   // linear problems of one with sparse ones
constexpr double steps_of_gmres = 15;    // in each of these
constexpr double slow = 8;               // operations of a factor in the time of one that a solution with it takes
constexpr double joined = 1.3;           // entries of the factor of joined bodies, over those of their own
constexpr std::size_t most_entries = 400;      // of a row of B, and of a column of K on average

using Eigen::VectorXd;

// The matrix of all subdomains, lower triangle: K, or what K^+ is the inverse of.
SparseMatrix of_all(const Subdomains& subdomains, const std::vector<int>& offset, bool regularised)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const SparseMatrix k = regularised ? subdomains[s]->regularised() : subdomains[s]->lower();
    for (int j = 0; j < k.cols(); ++j)
      for (SparseMatrix::InnerIterator it(k, j); it; ++it)
        entries.emplace_back(offset[s] + static_cast<int>(it.row()), offset[s] + j, it.value());
  }
  SparseMatrix result(offset.back(), offset.back());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

VectorXd joined_vector(const std::vector<VectorXd>& parts, Eigen::Index size)
{
  VectorXd result(size);
  Eigen::Index at = 0;
  for (const auto& part : parts) {
    result.segment(at, part.size()) = part;
    at += part.size();
  }
  return result;
}

}  // namespace

double work_of_dense_solution(double free, double closing)
{
  return free * free * free / 3 + free * free * closing + free * closing * closing +
         (1 + dense_guesses / 2) * closing * closing * closing;
}

double work_of_sparse_solution(double entries, double unknowns)
{
  const double l = joined * entries;
  return sparse_problems * (2 * l * l / std::max(unknowns, 1.0) + steps_of_gmres * slow * 4 * l);
}

bool SparseProblem::suits(const DualProblem& problem)
{
  const auto& subdomains = problem.clusters().subdomains();
  if (problem.communicator().size() > 1 || problem.springs() || problem.clusters().kinds() > 0 ||
      problem.equality().size() != problem.kernel_dimension())
    return false;
  std::vector<std::size_t> entries(problem.jump().rows()->getNodeNumElements(), 0);
  for (const auto& block : problem.jump().blocks())
    for (std::size_t r = 0; r < block.row.size(); ++r)
      entries[static_cast<std::size_t>(block.row[r])] += block.offset[r + 1] - block.offset[r];
  if (std::any_of(entries.begin(), entries.end(), [](std::size_t count) { return count > most_entries; })) return false;
  const auto constrained = problem.set().constrained();
  for (const Local i : constrained) entries[static_cast<std::size_t>(i)] = 0;
  const auto single = static_cast<Global>(std::count(entries.begin(), entries.end(), 1));
  const Global rows = problem.dual_unknowns() - (single > few_supports ? single : 0);
  if (rows < many_rows) return false;
  double unknowns = 0, factors = 0;
  for (const auto& subdomain : subdomains) {
    if (subdomain->lower().nonZeros() > static_cast<Eigen::Index>(most_entries) * subdomain->size()) return false;
    unknowns += subdomain->size();
    factors += static_cast<double>(subdomain->original().factor_bytes()) / sizeof(double);
  }
  const auto closing = static_cast<double>(constrained.size());
  return work_of_sparse_solution(factors, unknowns) <
         worth_of_sparse * work_of_dense_solution(static_cast<double>(rows) - closing, closing);
}

SparseProblem::SparseProblem(const DualProblem& problem) : problem_(problem), offset_{0}
{
  const auto& subdomains = problem.clusters().subdomains();
  for (const auto& subdomain : subdomains) offset_.push_back(offset_.back() + subdomain->size());
  stiffness_ = of_all(subdomains, offset_, false);
  const auto& jump = problem.jump();
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& block = jump.blocks()[s];
    for (std::size_t r = 0; r < block.row.size(); ++r) {
      const Local row = jump.rows()->getLocalElement(jump.touched_rows()->getGlobalElement(block.row[r]));
      for (auto i = block.offset[r]; i < block.offset[r + 1]; ++i)
        entries.emplace_back(row, offset_[s] + block.unknown[i], block.coefficient[i]);
    }
  }
  rows_.resize(static_cast<Eigen::Index>(jump.rows()->getNodeNumElements()), offset_.back());
  rows_.setFromTriplets(entries.begin(), entries.end());
  choose_supports();
  newton_ = std::make_unique<qp::SparseNewton>(reduced(stiffness_));
}

SparseProblem::~SparseProblem() = default;

// Rows without a constraint that hold one unknown, an unknown once.
void SparseProblem::choose_supports()
{
  std::vector<char> constrained(static_cast<std::size_t>(rows_.rows()), 0), taken(static_cast<std::size_t>(rows_.cols()), 0);
  for (const Local i : problem_.set().constrained()) constrained[static_cast<std::size_t>(i)] = 1;
  for (int row = 0; row < rows_.rows(); ++row) {
    const Rows::InnerIterator first(rows_, row);
    const bool single = rows_.outerIndexPtr()[row + 1] == rows_.outerIndexPtr()[row] + 1;
    if (single && constrained[static_cast<std::size_t>(row)] == 0 && !(problem_.jump().compliance()[row] > 0) &&
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
qp::SparseMatrices SparseProblem::reduced(const SparseMatrix& stiffness) const
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
  result.b.resize(static_cast<Eigen::Index>(kept_.size()), static_cast<Eigen::Index>(free_.size()));
  result.b.setFromTriplets(entries.begin(), entries.end());
  result.s = problem_.jump().compliance()(kept_);
  return result;
}

qp::FeasibleSet SparseProblem::reduced_set() const
{
  const auto number = [&](Local row) { return row < 0 ? -1 : number_[static_cast<std::size_t>(row)]; };
  std::vector<qp::Bound> bounds(problem_.set().bounds().begin(), problem_.set().bounds().end());
  std::vector<qp::Disc> discs(problem_.set().discs().begin(), problem_.set().discs().end());
  for (auto& bound : bounds) bound.index = number(bound.index);
  for (auto& disc : discs) {
    disc.index = {number(disc.index[0]), number(disc.index[1])};
    disc.normal = number(disc.normal);
  }
  return {std::move(bounds), std::move(discs)};
}

// The unknowns that supports hold, over all unknowns, where their rows are to see these bounds.
VectorXd SparseProblem::held(const Eigen::Ref<const VectorXd>& bounds) const
{
  VectorXd u = VectorXd::Zero(rows_.cols());
  for (const auto& support : supports_) u[support.unknown] = bounds[support.row] / support.coefficient;
  return u;
}

// The multipliers of all rows from those of the rows that are kept, where supports take up what `forces` lack.
Vector SparseProblem::complete(const VectorXd& kept, const VectorXd& forces) const
{
  Vector x(problem_.jump().rows());
  auto values = view(x);
  values.setZero();
  values(kept_) = kept;
  const VectorXd left = forces - rows_.transpose() * VectorXd(values);
  for (const auto& support : supports_) values[support.row] = left[support.unknown] / support.coefficient;
  return x;
}

SparseProblem::Result SparseProblem::solve() const
{
  return solve(joined_vector(problem_.load(), rows_.cols()), problem_.jump().bound(), nullptr);
}

// Forces R de move bodies and nothing else: c' = c + d - d' + B K^+ R de.
SparseProblem::Result SparseProblem::go_on(const Vector& linear, const VectorXd& e, const Vector& near) const
{
  const auto& clusters = problem_.clusters();
  const VectorXd more = e - problem_.equality().right_side();
  VectorXd f = joined_vector(problem_.load(), rows_.cols()), bound = problem_.jump().bound();
  std::vector<VectorXd> push;
  for (std::size_t s = 0; s + 1 < offset_.size(); ++s) {
    push.push_back(clusters.motion(s, more.segment(clusters.first(s), clusters.modes())));
    f.segment(offset_[s], push[s].size()) += push[s];
  }
  clusters.apply_inverse(push);
  bound += view(problem_.linear()) - view(linear) + rows_ * joined_vector(push, rows_.cols());
  return solve(f, bound, &near);
}

SparseProblem::Result SparseProblem::solve(const VectorXd& f, const VectorXd& bound, const Vector* near) const
{
  VectorXd u = held(bound);
  VectorXd load = f;
  load -= stiffness_.selfadjointView<Eigen::Lower>() * u;
  const VectorXd gap = bound - rows_ * u;
  qp::CondensedNewton::Point from;
  if (near) from = {view(*near)(kept_), last_(free_), false, 0, last_reaction_};
  const auto found = newton_->solve(load(free_), gap(kept_), reduced_set(), near ? &from : nullptr);
  u(free_) = found.nu;
  load = f;
  load -= stiffness_.selfadjointView<Eigen::Lower>() * u;
  const auto& clusters = problem_.clusters();
  Result result{complete(found.x, load), VectorXd::Zero(problem_.equality().size()), found.converged, found.steps,
                Vector(problem_.jump().rows())};
  std::vector<VectorXd> elastic = problem_.jump().apply_transpose(result.x);
  for (std::size_t s = 0; s < elastic.size(); ++s)
    elastic[s] = f.segment(offset_[s], elastic[s].size()) - elastic[s];
  clusters.apply_inverse(elastic);
  for (std::size_t s = 0; s < elastic.size(); ++s)
    result.nu.segment(clusters.first(s), clusters.modes()) =
        clusters.coordinates(s, elastic[s] - u.segment(offset_[s], elastic[s].size()));
  for (const Local i : problem_.set().constrained())
    view(result.reaction)[i] = found.reaction[number_[static_cast<std::size_t>(i)]];
  last_ = std::move(u);
  last_reaction_ = found.reaction;
  return result;
}

void SparseProblem::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  if (!inverse_) {
    regularised_ = of_all(problem_.clusters().subdomains(), offset_, true);
    inverse_ = std::make_unique<qp::SparseInverse>(reduced(regularised_));
  }
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto in = x.getVector(column);
    VectorXd u = held(view(*in));
    VectorXd force = VectorXd::Zero(u.size());
    force -= regularised_.selfadjointView<Eigen::Lower>() * u;
    const VectorXd jump = view(*in) - rows_ * u;
    const auto found = inverse_->solve(jump(kept_), force(free_));
    u(free_) = found.u;
    force = regularised_.selfadjointView<Eigen::Lower>() * u;
    y.getVectorNonConst(column)->update(alpha, complete(found.x, force), beta);
  }
}

}  // namespace mortise::feti
