#include "qp/equality.hpp"

#include <cmath>

#include "base/error.hpp"

namespace mortise::qp {

SparseMatrix sum_over_ranks(const SparseMatrix& part, const Communicator& comm)
{
  struct Entry {
    int row, column;
    double value;
  };
  std::vector<Entry> entries;
  for (int j = 0; j < part.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(part, j); it; ++it)
      if (it.row() >= j) entries.push_back({static_cast<int>(it.row()), j, it.value()});
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& entry : comm.all_gather(entries)) triplets.emplace_back(entry.row, entry.column, entry.value);
  SparseMatrix sum(part.rows(), part.cols());
  sum.setFromTriplets(triplets.begin(), triplets.end());
  return sum;
}

EqualityConstraint::EqualityConstraint(SparseMatrix g, const Communicator& comm) : comm_(comm), g_(std::move(g))
{
  if (size() == 0) return;
  const SparseMatrix transpose = g_.transpose();
  gram_ = sum_over_ranks(SparseMatrix((g_ * transpose).triangularView<Eigen::Lower>()), comm_);
  factor_ = std::make_unique<Cholesky>(gram_);
  if (!factor_->factorize(gram_))
    throw Error(ExitStatus::no_equilibrium,
                "the coarse problem is singular: some combination of rigid motions is felt by no constraint");
}

Eigen::VectorXd EqualityConstraint::apply(const Vector& x) const
{
  Eigen::VectorXd result = g_ * view(x);
  comm_.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

void EqualityConstraint::add_transpose(double alpha, const Eigen::VectorXd& nu, Vector& y) const
{
  if (size() == 0) return;
  auto values = view(y);
  for (Eigen::Index i = 0; i < g_.cols(); ++i) values[i] += alpha * g_.col(i).dot(nu);
}

Eigen::VectorXd EqualityConstraint::project(Vector& x) const
{
  if (size() == 0) return {};
  Eigen::VectorXd nu = solve(apply(x));
  add_transpose(-1, nu, x);
  return nu;
}

double EqualityConstraint::norm(const Eigen::VectorXd& r) const
{
  return size() == 0 ? 0.0 : std::sqrt(std::max(r.dot(solve(r)), 0.0));
}

}  // namespace mortise::qp
