// G D G', the matrix of the coarse problem on an active set of Omega or at a point of a projection: D is the identity but for the
// unknowns with constraints.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "qp/equality.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

/// The unknowns of one constraint: one, two or three (others are -1).
using BlockIndex = std::array<Local, 3>;

/// One symmetric block of I - D, by which an active constraint downdates G G'.
struct DowndateBlock {
  BlockIndex index{-1, -1, -1};
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
};

/// Only the rows of G that touch a constrained unknown feel D. With few of them all others are eliminated once and each
/// factorization is that of a small dense Schur complement; with many the whole is factorized sparsely. Every rank holds it.
class CoarseMatrix {
 public:
  /// (G D G')^-1 for one D. A sparse one uses the matrix's analysis of the pattern and its memory, which the next factorization
  /// takes: it is valid until then.
  class Factor {
   public:
    /// (G D G')^-1 r; r is over all rows of G, the same on every rank. Throws std::logic_error if it is not valid any more.
    Eigen::VectorXd solve(const Eigen::VectorXd& r) const;

   private:
    friend class CoarseMatrix;
    Factor(const CoarseMatrix& matrix, Eigen::LLT<Eigen::MatrixXd> schur)
        : matrix_(&matrix), schur_(std::move(schur)), number_(matrix.factorizations_)
    {
    }

    const CoarseMatrix* matrix_;
    Eigen::LLT<Eigen::MatrixXd> schur_;  // of the touched rows, where the matrix is dense and some are
    long long number_;                   // of the factorization
  };

  /// `blocks`: the unknowns of this rank's constraints, which may be downdated as a whole or in part. `equality` outlives it.
  /// With more than `largest_dense` touched rows, or where the sparse factor is smaller, there is no Schur complement. Throws
  /// Error(no_equilibrium) if the rows that no constraint touches are linearly dependent. Collective.
  CoarseMatrix(const EqualityConstraint& equality, std::span<const BlockIndex> blocks, int largest_dense = 2000);

  /// The factor of G D G' + `regularisation` diag(G G') over the touched rows; none if that is not positive definite.
  /// `downdates`: the blocks of this rank. Collective.
  [[nodiscard]] std::optional<Factor> factorize(std::span<const DowndateBlock> downdates, double regularisation);

  int touched() const { return static_cast<int>(touched_.size()); }  ///< rows of G with a constrained unknown, over all ranks

 private:
  // The columns of G of one constraint's unknowns as rows, and where the products of what they touch stand in changing_, lower
  // triangle by columns.
  struct Block {
    BlockIndex unknown;
    Eigen::Matrix3Xd g;
    std::vector<int> position;
  };
  void place(std::span<const BlockIndex> blocks);
  void eliminate();
  Eigen::VectorXd downdate(std::span<const DowndateBlock> downdates) const;

  const EqualityConstraint& equality_;
  std::vector<Block> blocks_;          // of this rank
  std::vector<int> block_;             // of each unknown of this rank: the largest it is in, -1 without one
  SparseMatrix changing_;              // where G D G' may differ from G G': the pattern counts
  std::vector<int> touched_, others_;  // rows of G
  std::vector<int> position_;          // of each row among `touched_`, -1 for the others
  bool dense_ = true;
  SparseMatrix whole_, matrix_;       // sparse: G G' with room for what changes, and what is factorized
  std::vector<int> in_whole_;         // sparse: of each entry of changing_, where it stands in these
  std::unique_ptr<Cholesky> factor_;  // dense: of the rows of others_ alone, none without any; else of all
  SparseMatrix coupling_;             // dense: touched x others
  Eigen::MatrixXd schur_;             // dense: with D = I, lower triangle
  long long factorizations_ = 0;
};

}  // namespace mortise::qp
