#include "qp/coarse_matrix.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/error.hpp"
#include "base/submatrix.hpp"

namespace mortise::qp {

namespace {

constexpr int small = 300;  // touched rows up to which dense matrices are quick in any case
constexpr int columns_at_once = 64;

// Where the entry (row, column) of a compressed matrix with sorted columns is stored, looked for from `from` on.
int position_of(const SparseMatrix& matrix, int row, int column, int from)
{
  const int* rows = matrix.innerIndexPtr();
  if (rows[from] == row) return from;
  return static_cast<int>(std::lower_bound(rows + from, rows + matrix.outerIndexPtr()[column + 1], row) - rows);
}

std::ptrdiff_t unknowns_in(const BlockIndex& block)
{
  return std::ranges::count_if(block, [](Local i) { return i >= 0; });
}

// Where G D G' may differ from G G', lower triangle: the rows of G that meet in a block of any rank.
SparseMatrix changing_pattern(const EqualityConstraint& equality, std::span<const BlockIndex> blocks)
{
  const SparseMatrix& g = equality.local();
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t c = 0; c < blocks.size(); ++c)
    for (const Local unknown : blocks[c])
      if (unknown >= 0)
        for (SparseMatrix::InnerIterator it(g, unknown); it; ++it)
          triplets.emplace_back(static_cast<int>(it.row()), static_cast<int>(c), 1.0);
  SparseMatrix columns(g.rows(), static_cast<Eigen::Index>(blocks.size()));
  columns.setFromTriplets(triplets.begin(), triplets.end());
  const SparseMatrix transpose = columns.transpose();
  return sum_over_ranks(SparseMatrix((columns * transpose).triangularView<Eigen::Lower>()), equality.communicator());
}

}  // namespace

CoarseMatrix::CoarseMatrix(const EqualityConstraint& equality, std::span<const BlockIndex> blocks, int largest_dense)
    : equality_(equality), changing_(changing_pattern(equality, blocks))
{
  position_.assign(static_cast<std::size_t>(equality.size()), -1);
  for (int i = 0; i < equality.size(); ++i) {
    const bool touched = changing_.outerIndexPtr()[i + 1] > changing_.outerIndexPtr()[i];  // its diagonal entry changes
    auto& list = touched ? touched_ : others_;
    if (touched) position_[static_cast<std::size_t>(i)] = static_cast<int>(list.size());
    list.push_back(i);
  }
  if (equality.size() == 0) return;
  place(blocks);
  dense_ = this->touched() <= largest_dense;
  if (dense_ && this->touched() > small) {
    const double entries = 0.5 * this->touched() * this->touched();
    dense_ = entries <= static_cast<double>(Cholesky(equality.gram()).factor_bytes()) / sizeof(double);
  }
  if (dense_) {
    eliminate();
    return;
  }
  whole_ = equality.gram() + 0.0 * changing_;
  matrix_ = whole_;
  factor_ = std::make_unique<Cholesky>(matrix_);
  for (int column = 0; column < changing_.outerSize(); ++column) {
    int from = whole_.outerIndexPtr()[column];
    for (SparseMatrix::InnerIterator it(changing_, column); it; ++it)
      in_whole_.push_back(from = position_of(whole_, static_cast<int>(it.row()), column, from));
  }
}

void CoarseMatrix::place(std::span<const BlockIndex> blocks)
{
  const SparseMatrix& g = equality_.local();
  block_.assign(static_cast<std::size_t>(g.cols()), -1);
  for (const auto& unknown : blocks) {
    std::vector<int> rows;
    for (const Local i : unknown)
      if (i >= 0)
        for (SparseMatrix::InnerIterator it(g, i); it; ++it) rows.push_back(static_cast<int>(it.row()));
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    Block block{unknown, Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(rows.size())), {}};
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      if (unknown[k] < 0) continue;
      for (SparseMatrix::InnerIterator it(g, unknown[k]); it; ++it)
        block.g(static_cast<Eigen::Index>(k), std::lower_bound(rows.begin(), rows.end(), it.row()) - rows.begin()) = it.value();
      int& largest = block_[static_cast<std::size_t>(unknown[k])];
      if (largest < 0 || unknowns_in(blocks_[static_cast<std::size_t>(largest)].unknown) < unknowns_in(unknown))
        largest = static_cast<int>(blocks_.size());
    }
    for (std::size_t j = 0; j < rows.size(); ++j) {
      int at = changing_.outerIndexPtr()[rows[j]];
      for (std::size_t i = j; i < rows.size(); ++i) block.position.push_back(at = position_of(changing_, rows[i], rows[j], at));
    }
    blocks_.push_back(std::move(block));
  }
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

// G (I - D) G' over the entries of changing_, summed over the ranks.
Eigen::VectorXd CoarseMatrix::downdate(std::span<const DowndateBlock> downdates) const
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(changing_.nonZeros());
  Eigen::Matrix3Xd times;
  for (const auto& [index, matrix] : downdates) {
    const Block& block = blocks_[static_cast<std::size_t>(block_[static_cast<std::size_t>(index[0])])];
    Eigen::Matrix3d select = Eigen::Matrix3d::Zero();  // the block's unknowns in the order of `index`
    for (Eigen::Index a = 0; a < 3; ++a)
      for (Eigen::Index b = 0; b < 3; ++b) {
        const Local unknown = index[static_cast<std::size_t>(a)];
        if (unknown >= 0 && unknown == block.unknown[static_cast<std::size_t>(b)]) select(a, b) = 1;
      }
    const Eigen::Matrix3d change = select.transpose() * matrix * select;
    times.noalias() = change * block.g;
    auto at = block.position.begin();
    for (Eigen::Index j = 0; j < times.cols(); ++j)
      for (Eigen::Index i = j; i < times.cols(); ++i) result[*at++] += times.col(i).dot(block.g.col(j));
  }
  equality_.communicator().sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

std::optional<CoarseMatrix::Factor> CoarseMatrix::factorize(std::span<const DowndateBlock> downdates, double regularisation)
{
  ++factorizations_;
  if (touched_.empty() && dense_) return Factor(*this, {});
  const SparseMatrix& gram = equality_.gram();
  const Eigen::VectorXd change = downdate(downdates);
  if (!dense_) {
    std::copy(whole_.valuePtr(), whole_.valuePtr() + whole_.nonZeros(), matrix_.valuePtr());
    for (std::size_t i = 0; i < in_whole_.size(); ++i) matrix_.valuePtr()[in_whole_[i]] -= change[static_cast<Eigen::Index>(i)];
    for (const int i : touched_) matrix_.coeffRef(i, i) += regularisation * gram.coeff(i, i);
    return factor_->factorize(matrix_) ? std::optional(Factor(*this, {})) : std::nullopt;
  }
  Eigen::MatrixXd schur = schur_;
  Eigen::Index next = 0;
  for (int column = 0; column < changing_.outerSize(); ++column)
    for (SparseMatrix::InnerIterator it(changing_, column); it; ++it)
      schur(position_[static_cast<std::size_t>(it.row())], position_[static_cast<std::size_t>(column)]) -= change[next++];
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    schur(at, at) += regularisation * gram.coeff(touched_[i], touched_[i]);
  }
  Factor factor(*this, Eigen::LLT<Eigen::MatrixXd>(schur));
  return factor.schur_.info() == Eigen::Success ? std::optional(std::move(factor)) : std::nullopt;
}

Eigen::VectorXd CoarseMatrix::Factor::solve(const Eigen::VectorXd& r) const
{
  const auto &touched = matrix_->touched_, &others = matrix_->others_;
  if (!matrix_->dense_) {
    if (number_ != matrix_->factorizations_) throw std::logic_error("the coarse matrix has been factorized anew since");
    return matrix_->factor_->solve(r);
  }
  if (others.empty()) return touched.empty() ? r : Eigen::VectorXd(schur_.solve(r));
  Eigen::VectorXd result(r.size());
  const Eigen::VectorXd inner = matrix_->factor_->solve(Eigen::VectorXd(r(others)));
  if (touched.empty()) {
    result(others) = inner;
    return result;
  }
  const Eigen::VectorXd outer = schur_.solve(r(touched) - matrix_->coupling_ * inner);
  result(touched) = outer;
  result(others) = inner - matrix_->factor_->solve(Eigen::VectorXd(matrix_->coupling_.transpose() * outer));
  return result;
}

}  // namespace mortise::qp
