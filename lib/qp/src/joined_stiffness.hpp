// The sparse matrix that is left of the direct method's system where what moves in contact is eliminated.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/cholesky.hpp"
#include "base/types.hpp"
#include "qp/sparse_newton.hpp"

namespace mortise::qp {

/// K + B'Z B for one Z after another, Z in blocks of unknowns that belong together. Their factors share one analysis of the
/// pattern and its memory, the largest of a direct solution. Heavy: moves, does not copy.
class JoinedStiffness {
 public:
  /// One block: its unknowns.
  using Block = std::vector<Local>;
  /// (K + B'Z B)^-1 for one Z. Uses memory of the stiffness, which stays where it is: valid until the next factorization there.
  class Factor {
   public:
    /// (K + B'Z B)^-1 r, to some figures. Throws std::logic_error if it is not valid any more.
    Eigen::VectorXd solve(const Eigen::VectorXd& r) const;

   private:
    friend class JoinedStiffness;
    Factor(const JoinedStiffness& stiffness, std::vector<Eigen::MatrixXd> z, bool symmetric)
        : stiffness_(&stiffness), z_(std::move(z)), symmetric_(symmetric), number_(stiffness.factorizations_)
    {
    }
    Eigen::VectorXd apply(const Eigen::VectorXd& u) const;

    const JoinedStiffness* stiffness_;
    std::vector<Eigen::MatrixXd> z_;
    bool symmetric_;    // what is factorized is K + B'Z B itself
    long long number_;  // of the factorization
  };
  /// `matrices` outlives it. `blocks`: every row of B once.
  JoinedStiffness(const SparseMatrices& matrices, std::vector<Block> blocks);

  const std::vector<Block>& blocks() const { return blocks_; }
  const SparseMatrices& matrices() const { return matrices_; }
  /// Of each unknown of x: its block, and which one it is there.
  struct InBlock {
    int block;
    int within;
  };
  InBlock in_block(Local unknown) const { return in_block_[static_cast<std::size_t>(unknown)]; }

  /// Takes Z and a symmetric positive semidefinite matrix that is near it for the factor, one matrix for each block. None if
  /// K + B'Z B is singular.
  [[nodiscard]] std::optional<Factor> factorize(std::vector<Eigen::MatrixXd> z, const std::vector<Eigen::MatrixXd>& near);

 private:
  // The columns of a block's rows of B, these rows, and where the entries of their products stand in lower_, lower triangle by
  // columns.
  struct Part {
    std::vector<int> column;
    Eigen::MatrixXd b;
    std::vector<int> position;
  };

  const SparseMatrices& matrices_;
  std::vector<Block> blocks_;
  std::vector<InBlock> in_block_;
  std::vector<Part> parts_;
  SparseMatrix stiffness_, lower_;  // K with room for B'Z B, and the sum of both
  std::unique_ptr<Cholesky> factor_;
  long long factorizations_ = 0;
};

}  // namespace mortise::qp
