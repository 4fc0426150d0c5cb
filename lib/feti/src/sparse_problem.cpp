#include "feti/sparse_problem.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "feti/explicit_problem.hpp"
#include "row_scaling.hpp"
#include "rows_on_root.hpp"
#include "whole_problem.hpp"

namespace mortise::feti {

namespace {

constexpr double dense_guesses = 8;     // of a direct solution with dense matrices
constexpr double sparse_problems = 30;  // linear problems of one with sparse ones
constexpr double steps_of_gmres = 15;   // in each of these
constexpr double slow = 8;              // operations of a factor in the time of one that a solution with it takes
constexpr double some_seconds = 1e11;   // operations
constexpr double half_a_minute = 1e12;
constexpr double joined = 1.3;             // entries of the factor of joined bodies, over those of their own
constexpr std::size_t most_entries = 400;  // of a row of B, and of a column of K on average

using Eigen::VectorXd;

Eigen::Map<const VectorXd> as_vector(const std::vector<double>& values)
{
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

// A matrix from rows, columns and values.
template <class Matrix>
Matrix assembled(const std::vector<double>& entries, Eigen::Index rows, Eigen::Index columns)
{
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(entries.size() / 3);
  for (std::size_t i = 0; i < entries.size(); i += 3)
    triplets.emplace_back(static_cast<int>(entries[i]), static_cast<int>(entries[i + 1]), entries[i + 2]);
  Matrix result(rows, columns);
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

// How many entries each owned row of B has. Collective.
std::vector<std::size_t> entries_of_rows(const JumpOperator& jump)
{
  Vector touched(jump.touched_rows()), owned(jump.rows());
  for (const auto& block : jump.blocks())
    for (std::size_t r = 0; r < block.row.size(); ++r)
      view(touched)[block.row[r]] += static_cast<double>(block.offset[r + 1] - block.offset[r]);
  owned.doExport(touched, jump.import(), Tpetra::ADD);
  std::vector<std::size_t> entries;
  for (const double count : view(owned)) entries.push_back(static_cast<std::size_t>(count));
  return entries;
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

SparseProblem::Turn SparseProblem::turn(const DualSystem& system, bool slender)
{
  const auto& comm = system.communicator();
  const auto& subdomains = system.clusters().subdomains();
  auto entries = entries_of_rows(system.jump());
  bool dense = system.springs() || system.clusters().kinds() > 0;
  dense = dense || (system.equality().size() != system.kernel_dimension() && !system.gauged().empty());
  const auto& jump = system.jump();
  const Global end = system.gauges_hold_free_motions() ? jump.contact_rows().second : system.dual_unknowns();
  for (std::size_t i = 0; i < entries.size(); ++i)
    dense = dense || (entries[i] > most_entries && jump.rows()->getGlobalElement(static_cast<Local>(i)) < end);
  double unknowns = 0, factors = 0;
  for (const auto& subdomain : subdomains) {
    dense = dense || subdomain->lower().nonZeros() > static_cast<Eigen::Index>(most_entries) * subdomain->size();
    unknowns += subdomain->size();
    factors += static_cast<double>(subdomain->original().factor_bytes()) / sizeof(double);
  }
  const auto constrained = system.set().constrained();
  for (const Local i : constrained) entries[static_cast<std::size_t>(i)] = 0;
  std::vector<double> sums{dense ? 1.0 : 0.0, unknowns, factors, static_cast<double>(constrained.size()),
                           static_cast<double>(std::count(entries.begin(), entries.end(), 1))};
  comm.sum_in_place(sums);
  const double closing = sums[3], single = sums[4];
  const double rows = static_cast<double>(system.dual_unknowns()) - (single > few_supports ? single : 0);
  const double work = work_of_sparse_solution(sums[2], sums[1]);
  const double dense_work = work_of_dense_solution(rows - closing, closing);
  const bool quick = work < worth_of_sparse * dense_work;
  if (sums[0] > 0) return Turn::never;
  if (quick && rows >= many_rows) return dense_work < half_a_minute ? Turn::first : Turn::alone;
  return quick || slender || work < some_seconds ? Turn::second : Turn::never;
}

SparseProblem::SparseProblem(const DualSystem& system, bool slender)
    : system_(system), slender_(slender), inverse_([this] { return make_inverse(); })
{
  const auto& comm = system.communicator();
  const auto& jump = system.jump();
  long long own = 0;
  for (const auto& subdomain : system.clusters().subdomains()) own += subdomain->size();
  offset_.push_back(static_cast<int>(comm.offset(own)));
  for (const auto& subdomain : system.clusters().subdomains()) offset_.push_back(offset_.back() + subdomain->size());
  unknowns_ = static_cast<int>(comm.sum(own));
  const auto owned = jump.rows()->getMyGlobalIndices();
  std::vector<Global> number;
  for (std::size_t i = 0; i < owned.extent(0); ++i) number.push_back(owned[i]);
  rows_ = std::make_unique<RowsOnRoot>(std::move(number), comm);

  std::vector<double> entries;
  for (std::size_t s = 0; s + 1 < offset_.size(); ++s) {
    const auto& block = jump.blocks()[s];
    for (std::size_t r = 0; r < block.row.size(); ++r)
      for (auto i = block.offset[r]; i < block.offset[r + 1]; ++i)
        entries.insert(entries.end(), {static_cast<double>(jump.touched_rows()->getGlobalElement(block.row[r])),
                                       static_cast<double>(offset_[s] + block.unknown[i]), block.coefficient[i]});
  }
  others_ = static_cast<int>(system.equality().size() - system.kernel_dimension());
  const SparseMatrix& g = system.equality().local();  // -parts of the unknowns besides: row . u = bound + part s
  for (int j = 0; j < g.cols(); ++j)
    for (SparseMatrix::InnerIterator it(g, j); it; ++it)
      if (const auto k = static_cast<int>(it.row()) - system.kernel_dimension(); k >= 0)
        entries.insert(entries.end(), {static_cast<double>(owned[static_cast<std::size_t>(j)]),
                                       static_cast<double>(unknowns_ + k), -it.value()});
  entries = feti::on_root(std::move(entries), comm);
  const auto compliance = rows_->to_root(RowScaling::compliance_of(jump));
  const auto set = rows_->to_root(system.set());
  SparseMatrix stiffness = stiffness_on_root(false);
  const auto motions = motions_on_root();
  collectively(comm, [&] {
    if (!comm.root()) return;
    auto rows = assembled<SupportElimination::Rows>(entries, system.dual_unknowns(), unknowns_ + others_);
    gauges_ = std::make_unique<Gauges>(rows, motions);
    if (others_ > 0) {
      const Eigen::SparseMatrix<double> of_subdomains = Eigen::SparseMatrix<double>(rows).leftCols(unknowns_);
      of_inverse_ = std::make_unique<SupportElimination>(of_subdomains, as_vector(compliance), set);
    }
    elimination_ = std::make_unique<SupportElimination>(std::move(rows), as_vector(compliance), set);
    stiffness.conservativeResize(unknowns_ + others_, unknowns_ + others_);
    whole_ = std::make_unique<WholeProblem>(std::move(stiffness), *elimination_, slender);
  });
}

SparseProblem::~SparseProblem() = default;

// The matrix of all subdomains, lower triangle: K, or what K^+ is the inverse of. Nothing elsewhere. Collective.
SparseMatrix SparseProblem::stiffness_on_root(bool regularised) const
{
  const auto& comm = system_.communicator();
  const auto& subdomains = system_.clusters().subdomains();
  std::vector<double> entries;
  SparseMatrix result;
  collectively(comm, [&] {
    for (std::size_t s = 0; s < subdomains.size(); ++s) {
      const SparseMatrix k = regularised ? subdomains[s]->regularised() : subdomains[s]->lower();
      for (int j = 0; j < k.cols(); ++j)
        for (SparseMatrix::InnerIterator it(k, j); it; ++it)
          entries.insert(entries.end(),
                         {static_cast<double>(offset_[s] + it.row()), static_cast<double>(offset_[s] + j), it.value()});
    }
  });
  entries = feti::on_root(std::move(entries), comm);
  collectively(comm, [&] {
    if (comm.root()) result = assembled<SparseMatrix>(entries, unknowns_, unknowns_);
  });
  return result;
}

// The motions that gauges hold and nothing resists, as columns; none if facets resist any. Nothing elsewhere. Collective.
Eigen::SparseMatrix<double> SparseProblem::motions_on_root() const
{
  const auto& comm = system_.communicator();
  if (!system_.gauges_hold_free_motions()) return Eigen::SparseMatrix<double>(unknowns_ + others_, 0);
  const auto motions = system_.gauged_motions();
  std::vector<double> entries;
  for (std::size_t k = 0; k < motions.size(); ++k)
    for (std::size_t s = 0; s < motions[k].size(); ++s)
      for (Eigen::Index i = 0; i < motions[k][s].size(); ++i)
        if (motions[k][s][i] != 0)
          entries.insert(entries.end(), {static_cast<double>(offset_[s] + i), static_cast<double>(k), motions[k][s][i]});
  entries = feti::on_root(std::move(entries), comm);
  return assembled<Eigen::SparseMatrix<double>>(entries, unknowns_, static_cast<Eigen::Index>(motions.size()));
}

// What the subdomains of all ranks have, one after the other. Collective.
VectorXd SparseProblem::on_root(const std::vector<VectorXd>& parts) const
{
  std::vector<double> own;
  for (const auto& part : parts) own.insert(own.end(), part.begin(), part.end());
  return as_vector(feti::on_root(std::move(own), system_.communicator()));
}

SparseProblem::Result SparseProblem::solve(const qp::RightHandSide& right, const qp::FeasibleSet& set) const
{
  return solve(right.f, right.c, right.e, set, nullptr);
}

// Forces R de move bodies and nothing else: c' = c + d - d' + B K^+ R de.
SparseProblem::Result SparseProblem::go_on(const qp::RightHandSide& right, const Vector& linear, const VectorXd& e,
                                           const qp::FeasibleSet& set, const Result& near) const
{
  const auto& clusters = system_.clusters();
  const VectorXd more = e - right.e;
  std::vector<VectorXd> push, f = right.f;
  for (std::size_t s = 0; s < f.size(); ++s) {
    push.push_back(clusters.motion(s, more.segment(clusters.first(s), clusters.modes())));
    f[s] += push[s];
  }
  clusters.apply_inverse(push);
  const Vector moved = system_.jump().apply(push);
  const VectorXd bound = right.c + view(right.b) - view(linear) + view(moved);
  return solve(f, bound, e, set, &near);
}

SparseProblem::Result SparseProblem::solve(const std::vector<VectorXd>& f, const VectorXd& bound, const VectorXd& e,
                                           const qp::FeasibleSet& set, const Result* near) const
{
  const auto& comm = system_.communicator();
  VectorXd load = on_root(f);
  load.conservativeResize(load.size() + others_);
  load.tail(others_) = -e.tail(others_);
  const bool known = near && near->reaction;
  const auto c = rows_->to_root(bound), start = known ? rows_->to_root(view(near->x)) : std::vector<double>(),
             felt = known ? rows_->to_root(view(*near->reaction)) : std::vector<double>();
  const auto set_on_root = rows_->to_root(set);
  std::vector<double> x, u, reaction;
  std::vector<long long> outcome;
  collectively(comm, [&] {
    if (!comm.root()) return;
    const WholeProblem::Start from{as_vector(start), as_vector(felt), known && near->converged};
    auto found = whole_->solve(load, as_vector(c), set_on_root, known ? &from : nullptr);
    gauges_->restore(as_vector(c), found.x, found.u);
    x.assign(found.x.begin(), found.x.end());
    u.assign(found.u.begin(), found.u.end());
    reaction.assign(found.reaction.begin(), found.reaction.end());
    outcome = {found.converged ? 1 : 0, found.settled ? 1 : 0};
  });
  comm.broadcast(u);
  comm.broadcast(outcome);
  Result result{Vector(system_.jump().rows()), VectorXd::Zero(system_.equality().size()), outcome[0] == 1,
                Vector(system_.jump().rows()), outcome[1] == 1};
  view(result.x) = rows_->from_root(std::move(x));
  view(*result.reaction) = rows_->from_root(std::move(reaction));

  const auto& clusters = system_.clusters();  // R nu = K^+ (f - B'x) - u
  std::vector<VectorXd> elastic = system_.jump().apply_transpose(result.x);
  for (std::size_t s = 0; s < elastic.size(); ++s) elastic[s] = f[s] - elastic[s];
  clusters.apply_inverse(elastic);
  for (std::size_t s = 0; s < elastic.size(); ++s)
    result.nu.segment(clusters.first(s), clusters.modes()) =
        clusters.coordinates(s, elastic[s] - as_vector(u).segment(offset_[s], elastic[s].size()));
  comm.sum_in_place({result.nu.data(), static_cast<std::size_t>(result.nu.size())});
  result.nu.tail(others_) = as_vector(u).tail(others_);
  return result;
}

// F^-1 on rank 0. Collective.
std::unique_ptr<const WholeInverse> SparseProblem::make_inverse() const
{
  const auto& comm = system_.communicator();
  SparseMatrix regularised = stiffness_on_root(true);
  std::unique_ptr<const WholeInverse> inverse;
  collectively(comm, [&] {
    if (!comm.root()) return;
    inverse = std::make_unique<WholeInverse>(std::move(regularised), of_inverse_ ? *of_inverse_ : *elimination_, slender_);
  });
  return inverse;
}

void SparseProblem::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto& inverse = inverse_.get();
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    Vector result(system_.jump().rows());
    view(result) = rows_->map_on_root(view(*x.getVector(column)), [&](const VectorXd& all) { return inverse->times(all); });
    y.getVectorNonConst(column)->update(alpha, result, beta);
  }
}

}  // namespace mortise::feti
