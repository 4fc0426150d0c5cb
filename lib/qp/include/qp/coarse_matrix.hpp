// G D G', the matrix of the coarse problem on a face of Omega or at a point of a projection: D is the identity but for the
// unknowns with constraints.
#pragma once

#include <array>
#include <span>

#include "qp/equality.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

/// One symmetric block of I - D: what a constraint takes away from one unknown (index[1] is -1) or from two.
struct LostBlock {
  std::array<Local, 2> index{-1, -1};
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
};

/// Only the rows of G that touch a constrained unknown feel D. With few of them all others are eliminated once and each
/// factorization is that of a small dense Schur complement; with many the whole is factorized sparsely. Every rank holds it.
class CoarseMatrix {
 public:
  /// `constrained`: the unknowns of this rank that blocks may name. `equality` outlives it. Collective.
  CoarseMatrix(const EqualityConstraint& equality, std::span<const Local> constrained);

  /// Factorizes G D G' + `regularisation` diag(G G') over the touched rows. Returns false if that is not positive definite.
  /// `lost`: the blocks of this rank. Collective.
  [[nodiscard]] bool factorize(std::span<const LostBlock> lost, double regularisation);
  /// Of the matrix that was factorized last.
  Eigen::VectorXd solve(const Eigen::VectorXd& r) const;

  int touched() const { return static_cast<int>(touched_.size()); }  ///< rows of G with a constrained unknown, over all ranks

 private:
  void eliminate();

  const EqualityConstraint& equality_;
  std::vector<int> touched_, others_;  // rows of G
  std::vector<int> place_;             // of each row among `touched_`, -1 for the others
  bool dense_ = true;
  std::unique_ptr<Cholesky> factor_;  // dense: of the rows of others_ alone; else of all
  SparseMatrix coupling_;             // dense: touched x others
  Eigen::MatrixXd schur_;             // dense: with D = I, lower triangle
  Eigen::LLT<Eigen::MatrixXd> schur_factor_;
};

}  // namespace mortise::qp
