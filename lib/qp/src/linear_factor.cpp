#include "linear_factor.hpp"

#include <optional>
#include <utility>

#include "base/sparse_lu.hpp"

namespace mortise::qp {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class EliminatedFactor : public LinearFactor {
 public:
  EliminatedFactor(const JoinedStiffness& stiffness, JoinedStiffness::Factor factor, BlockEquations equations,
                   std::vector<MatrixXd> inverse)
      : stiffness_(stiffness), factor_(std::move(factor)), equations_(std::move(equations)), inverse_(std::move(inverse))
  {
  }

  Step solve(const VectorXd& f, const std::vector<VectorXd>& r) const override
  {
    const auto& b = stiffness_.matrices().b;
    const auto& blocks = stiffness_.blocks();
    VectorXd pushed = VectorXd::Zero(b.rows());
    for (std::size_t k = 0; k < blocks.size(); ++k) pushed(blocks[k]) = equations_.trial[k] * (inverse_[k] * r[k]);
    Step step{factor_.solve(f - b.transpose() * pushed), {}};
    const VectorXd jump = b * step.u;
    for (std::size_t k = 0; k < blocks.size(); ++k)
      step.a.emplace_back(inverse_[k] * (r[k] + equations_.test[k] * jump(blocks[k])));
    return step;
  }

 private:
  const JoinedStiffness& stiffness_;
  JoinedStiffness::Factor factor_;
  BlockEquations equations_;
  std::vector<MatrixXd> inverse_;
};

class SaddleFactor : public LinearFactor {
 public:
  SaddleFactor(std::unique_ptr<const SparseLu> factor, Index unknowns) : factor_(std::move(factor)), unknowns_(unknowns) {}

  Step solve(const VectorXd& f, const std::vector<VectorXd>& r) const override
  {
    Index rows = unknowns_;
    for (const auto& part : r) rows += part.size();
    VectorXd right(rows);
    right.head(unknowns_) = f;
    Index at = unknowns_;
    for (const auto& part : r) {
      right.segment(at, part.size()) = part;
      at += part.size();
    }
    const VectorXd found = factor_->solve(right);
    Step step{found.head(unknowns_), {}};
    at = unknowns_;
    for (const auto& part : r) {
      step.a.emplace_back(found.segment(at, part.size()));
      at += part.size();
    }
    return step;
  }

 private:
  std::unique_ptr<const SparseLu> factor_;
  Index unknowns_;  // of u, which come first
};

// [K, B'T; -E B, C].
SparseMatrix saddle_matrix(const SparseMatrices& matrices, const std::vector<JoinedStiffness::Block>& blocks,
                           const BlockEquations& equations)
{
  const auto& [k, b, s] = matrices;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index row, Index column, double value) {
    if (value != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (int j = 0; j < k.cols(); ++j)
    for (SparseMatrix::InnerIterator it(k, j); it; ++it) {
      add(it.row(), it.col(), it.value());
      if (it.row() != it.col()) add(it.col(), it.row(), it.value());
    }
  Index at = k.cols();
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const auto &trial = equations.trial[block], &test = equations.test[block], &compliance = equations.compliance[block];
    for (Index a = 0; a < compliance.rows(); ++a) {
      for (Index other = 0; other < compliance.cols(); ++other) add(at + a, at + other, compliance(a, other));
      for (Index i = 0; i < trial.rows(); ++i)
        for (decltype(matrices.b)::InnerIterator it(b, blocks[block][static_cast<std::size_t>(i)]); it; ++it) {
          add(it.col(), at + a, it.value() * trial(i, a));
          add(at + a, it.col(), -it.value() * test(a, i));
        }
    }
    at += compliance.rows();
  }
  SparseMatrix result(at, at);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

std::unique_ptr<LinearFactor> eliminated_factor(JoinedStiffness& stiffness, BlockEquations equations,
                                                std::vector<MatrixXd> inverse, const std::vector<MatrixXd>& near)
{
  std::vector<MatrixXd> z;
  for (std::size_t k = 0; k < inverse.size(); ++k) z.emplace_back(equations.trial[k] * inverse[k] * equations.test[k]);
  auto factor = stiffness.factorize(std::move(z), near);
  if (!factor) return nullptr;
  return std::make_unique<EliminatedFactor>(stiffness, std::move(*factor), std::move(equations), std::move(inverse));
}

std::unique_ptr<LinearFactor> saddle_factor(const SparseMatrices& matrices, const std::vector<JoinedStiffness::Block>& blocks,
                                            const BlockEquations& equations)
{
  auto factor = SparseLu::factorized(saddle_matrix(matrices, blocks, equations));
  if (!factor) return nullptr;
  return std::make_unique<SaddleFactor>(std::move(factor), matrices.k.cols());
}

VectorXd lacking_forces(const SparseMatrices& matrices, const VectorXd& x, const ExtendedVector& u, const VectorXd& e)
{
  ExtendedVector sums = -e.cast<long double>();
  subtract_product(matrices.k, u, sums);
  subtract_transposed_product(matrices.b, x, sums);
  return sums.cast<double>();
}

}  // namespace mortise::qp
