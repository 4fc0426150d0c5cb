#include "qp/coarse_matrix.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/submatrix.hpp"

namespace mortise::qp {

namespace {

constexpr int largest_dense = 2000;  // above this the sparse factorization of all rows is the faster one
constexpr int columns_at_once = 64;

}  // namespace

CoarseMatrix::CoarseMatrix(const EqualityConstraint& equality, std::span<const Local> constrained) : equality_(equality)
{
  const auto size = static_cast<std::size_t>(equality.size());
  std::vector<double> touched(size, 0.0);
  for (const Local column : constrained)
    for (SparseMatrix::InnerIterator it(equality.local(), column); it; ++it) touched[static_cast<std::size_t>(it.row())] = 1;
  equality.communicator().sum_in_place(touched);
  place_.assign(size, -1);
  for (std::size_t i = 0; i < size; ++i) {
    auto& list = touched[i] > 0 ? touched_ : others_;
    if (touched[i] > 0) place_[i] = static_cast<int>(list.size());
    list.push_back(static_cast<int>(i));
  }
  dense_ = this->touched() <= largest_dense;
  if (size == 0) return;
  if (dense_)
    eliminate();
  else
    factor_ = std::make_unique<Cholesky>(equality.gram());
}

void CoarseMatrix::eliminate()
{
  const SparseMatrix& gram = equality_.gram();
  schur_ = Eigen::MatrixXd(submatrix(gram, touched_, touched_, true));
  if (others_.empty()) return;
  const SparseMatrix inner = submatrix(gram, others_, others_, true);
  factor_ = std::make_unique<Cholesky>(inner);
  if (!factor_->factorize(inner))
    throw Error(ExitStatus::no_equilibrium, "the coarse problem is singular away from all contacts");
  coupling_ = submatrix(gram, touched_, others_, false);
  const SparseMatrix transpose = coupling_.transpose();
  for (Eigen::Index first = 0; first < transpose.cols(); first += columns_at_once) {
    const auto count = std::min<Eigen::Index>(columns_at_once, transpose.cols() - first);
    Eigen::MatrixXd solved = transpose.middleCols(first, count);
    factor_->solve(solved.data(), solved.data(), static_cast<int>(count), static_cast<int>(solved.rows()));
    schur_.middleCols(first, count) -= coupling_ * solved;
  }
}

bool CoarseMatrix::factorize(std::span<const LostBlock> lost, double regularisation)
{
  if (touched_.empty() && dense_) return true;
  const SparseMatrix& g = equality_.local();
  const SparseMatrix& gram = equality_.gram();
  // Every pair of entries of G that a block joins: row, row, value.
  const auto visit = [&](const auto& add) {
    for (const auto& entry : lost)
      for (int a = 0; a < 2 && entry.index[static_cast<std::size_t>(a)] >= 0; ++a)
        for (int b = 0; b < 2 && entry.index[static_cast<std::size_t>(b)] >= 0; ++b) {
          if (entry.matrix(a, b) == 0) continue;
          for (SparseMatrix::InnerIterator i(g, entry.index[static_cast<std::size_t>(a)]); i; ++i)
            for (SparseMatrix::InnerIterator j(g, entry.index[static_cast<std::size_t>(b)]); j; ++j)
              if (i.row() >= j.row())
                add(static_cast<int>(i.row()), static_cast<int>(j.row()), entry.matrix(a, b) * i.value() * j.value());
        }
  };
  if (!dense_) {
    std::vector<Eigen::Triplet<double>> triplets;
    visit([&](int row, int column, double value) { triplets.emplace_back(row, column, value); });
    SparseMatrix local(gram.rows(), gram.cols());
    local.setFromTriplets(triplets.begin(), triplets.end());
    SparseMatrix matrix = gram - sum_over_ranks(local, equality_.communicator());
    for (const int i : touched_) matrix.coeffRef(i, i) += regularisation * gram.coeff(i, i);
    return factor_->factorize(matrix);
  }
  Eigen::MatrixXd taken = Eigen::MatrixXd::Zero(schur_.rows(), schur_.cols());
  visit([&](int row, int column, double value) {
    taken(place_[static_cast<std::size_t>(row)], place_[static_cast<std::size_t>(column)]) += value;
  });
  equality_.communicator().sum_in_place({taken.data(), static_cast<std::size_t>(taken.size())});
  taken = schur_ - taken;
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    taken(at, at) += regularisation * gram.coeff(touched_[i], touched_[i]);
  }
  schur_factor_.compute(taken);
  return schur_factor_.info() == Eigen::Success;
}

Eigen::VectorXd CoarseMatrix::solve(const Eigen::VectorXd& r) const
{
  if (!dense_) return factor_->solve(r);
  if (others_.empty()) return touched_.empty() ? r : Eigen::VectorXd(schur_factor_.solve(r));
  Eigen::VectorXd result(r.size());
  const Eigen::VectorXd inner = factor_->solve(Eigen::VectorXd(r(others_)));
  if (touched_.empty()) {
    result(others_) = inner;
    return result;
  }
  const Eigen::VectorXd outer = schur_factor_.solve(r(touched_) - coupling_ * inner);
  result(touched_) = outer;
  result(others_) = inner - factor_->solve(Eigen::VectorXd(coupling_.transpose() * outer));
  return result;
}

}  // namespace mortise::qp
