#include "joined_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/interruption.hpp"
#include "base/submatrix.hpp"
#include "gmres.hpp"

namespace mortise::qp {

namespace {

constexpr int most_steps_of_gmres = 80;
constexpr double reduction_of_gmres = 1e-5;  // of the residual: solutions are repeated
constexpr double held = 1e-13;               // of the diagonal of K, that holds what nothing else does

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Where the entry (row, column) of a compressed matrix with sorted columns is stored.
int stored_at(const SparseMatrix& matrix, int row, int column)
{
  const int* rows = matrix.innerIndexPtr();
  return static_cast<int>(
      std::lower_bound(rows + matrix.outerIndexPtr()[column], rows + matrix.outerIndexPtr()[column + 1], row) - rows);
}

}  // namespace

JoinedStiffness::JoinedStiffness(const SparseMatrices& matrices, std::vector<Block> blocks)
    : matrices_(matrices), blocks_(std::move(blocks)), in_block_(static_cast<std::size_t>(matrices.b.rows()))
{
  std::vector<Eigen::Triplet<double>> pattern;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    Part part;
    for (std::size_t i = 0; i < blocks_[k].size(); ++i) {
      in_block_[static_cast<std::size_t>(blocks_[k][i])] = {static_cast<int>(k), static_cast<int>(i)};
      for (decltype(matrices_.b)::InnerIterator it(matrices_.b, blocks_[k][i]); it; ++it)
        part.column.push_back(static_cast<int>(it.col()));
    }
    std::sort(part.column.begin(), part.column.end());
    part.column.erase(std::unique(part.column.begin(), part.column.end()), part.column.end());
    part.b = MatrixXd::Zero(static_cast<Index>(blocks_[k].size()), static_cast<Index>(part.column.size()));
    for (std::size_t i = 0; i < blocks_[k].size(); ++i)
      for (decltype(matrices_.b)::InnerIterator it(matrices_.b, blocks_[k][i]); it; ++it)
        part.b(static_cast<Index>(i), std::lower_bound(part.column.begin(), part.column.end(), it.col()) - part.column.begin()) =
            it.value();
    for (std::size_t j = 0; j < part.column.size(); ++j)
      for (std::size_t i = j; i < part.column.size(); ++i) pattern.emplace_back(part.column[i], part.column[j], 0.0);
    parts_.push_back(std::move(part));
  }
  for (int j = 0; j < matrices.k.cols(); ++j) pattern.emplace_back(j, j, 0.0);
  SparseMatrix room(matrices.k.rows(), matrices.k.cols());
  room.setFromTriplets(pattern.begin(), pattern.end());
  stiffness_ = matrices.k + room;
  stiffness_.makeCompressed();
  for (int j = 0; j < stiffness_.cols(); ++j) stiffness_.valuePtr()[stored_at(stiffness_, j, j)] *= 1 + held;
  for (auto& part : parts_)
    for (std::size_t j = 0; j < part.column.size(); ++j)
      for (std::size_t i = j; i < part.column.size(); ++i)
        part.position.push_back(stored_at(stiffness_, part.column[i], part.column[j]));
  lower_ = stiffness_;
  factor_ = std::make_unique<Cholesky>(lower_);
}

std::optional<JoinedStiffness::Factor> JoinedStiffness::factorize(std::vector<MatrixXd> z, const std::vector<MatrixXd>& near)
{
  stop_if_requested();
  std::copy(stiffness_.valuePtr(), stiffness_.valuePtr() + stiffness_.nonZeros(), lower_.valuePtr());
  bool symmetric = true;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const auto& part = parts_[k];
    symmetric = symmetric && z[k] == near[k];
    const MatrixXd times = near[k] * part.b;
    auto at = part.position.begin();
    for (Index j = 0; j < part.b.cols(); ++j)
      for (Index i = j; i < part.b.cols(); ++i) lower_.valuePtr()[*at++] += part.b.col(i).dot(times.col(j));
  }
  ++factorizations_;
  if (!factor_->factorize(lower_)) return std::nullopt;
  if (!symmetric) factor_->prepare_for_many_solves();  // by GMRES
  return Factor(*this, std::move(z), symmetric);
}

VectorXd JoinedStiffness::Factor::apply(const VectorXd& u) const
{
  const auto& b = stiffness_->matrices_.b;
  const auto& blocks = stiffness_->blocks_;
  VectorXd result = stiffness_->stiffness_.selfadjointView<Eigen::Lower>() * u;
  const VectorXd jump = b * u;
  VectorXd force(jump.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) force(blocks[i]) = z_[i] * jump(blocks[i]);
  result += b.transpose() * force;
  return result;
}

VectorXd JoinedStiffness::Factor::solve(const VectorXd& r) const
{
  if (number_ != stiffness_->factorizations_) throw std::logic_error("the stiffness has been factorized anew since");
  const Cholesky& near = *stiffness_->factor_;
  const double size = r.norm();
  if (symmetric_ || !(size > 0) || !std::isfinite(size)) return near.solve(r);
  VectorXd u = VectorXd::Zero(r.size());
  const auto turned = [&](VectorXd& v) {
    v = near.solve(v);
    return apply(v);
  };
  const double left = gmres(turned, r, reduction_of_gmres * size, most_steps_of_gmres, u);
  if (!std::isfinite(left)) u.setConstant(left);
  return u;
}

}  // namespace mortise::qp
