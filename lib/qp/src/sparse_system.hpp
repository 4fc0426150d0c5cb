// The direct method's system with nothing eliminated, for bodies whose stiffness is sparse:
//
//     S x - B u + c = s,   K u + B'x = f,   s in the normal cone of Omega at x,
//
// which is that of contact_system.hpp with W = S, H = -B', C = K, nu = u, b = -c and e = -f. A linear problem has, beside these,
// a matrix of up to three rows for each point of contact: x = base + Z (B u - ..). With x eliminated it is K + B'Z B, sparse and
// of one pattern for all of them. Its symmetric part without what normal forces do to friction is positive definite: factors of
// that and a few steps of GMRES solve it [Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986)].
//
// Constraints that do not give way at all would be infinitely stiff. They give way by a tiny part of what their nodes do, and
// solutions are repeated with what is left.
#pragma once

#include <optional>

#include "base/cholesky.hpp"
#include "contact_system.hpp"
#include "qp/feasible_set.hpp"
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

class SparseSystem : public ContactSystem {
 public:
  /// `matrices` outlives it. `set`: over all rows of B; which of them belong together.
  SparseSystem(const SparseMatrices& matrices, const FeasibleSet& set);

  Eigen::Index unknowns() const override { return matrices_.b.rows(); }
  Eigen::Index motions() const override { return matrices_.b.cols(); }
  const Eigen::VectorXd& own() const override { return own_; }
  double largest_ratio() const override;
  bool costly() const override { return true; }

  Eigen::VectorXd give(const Eigen::VectorXd& x) const override { return matrices_.s.cwiseProduct(x); }
  Eigen::VectorXd push(const Eigen::VectorXd& u) const override { return -(matrices_.b * u); }
  Eigen::VectorXd excess(const Eigen::VectorXd& x, const Eigen::VectorXd& u, const Eigen::VectorXd& e) const override;
  Eigen::VectorXd lack(const Eigen::VectorXd& x, const Eigen::VectorXd& u, const Eigen::VectorXd& e) const override
  {
    return -excess(x, u, e);
  }
  Eigen::VectorXd size_of_give(const Eigen::VectorXd& x) const override { return matrices_.s.cwiseProduct(x.cwiseAbs()); }
  double square_of_rounding(const Eigen::VectorXd& x, const Eigen::VectorXd& u) const override;

  /// By the diagonal of K, and what stands in for it where there is no stiffness.
  double square(const Eigen::VectorXd& l) const override { return l.dot(l.cwiseQuotient(diagonal_)); }
  void solve(const Guess& guess, const Eigen::VectorXd& b, const Eigen::VectorXd& e, Eigen::VectorXd& x,
             Eigen::VectorXd& u) override;
  std::unique_ptr<PathFactor> factor(std::span<const Stiffening> entries, std::span<const Local> pinned,
                                     bool symmetric) const override;

 private:
  class Step;
  struct Moving;

  Moving moving(const Guess& guess) const;

  const SparseMatrices& matrices_;
  Eigen::VectorXd diagonal_, own_;
  mutable JoinedStiffness stiffness_;  // its factors take its memory
};

}  // namespace mortise::qp
