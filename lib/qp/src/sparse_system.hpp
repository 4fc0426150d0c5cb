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
// solutions are repeated with what is left. Where even that is too stiff beside the softest motions of thin bodies, factors are
// those of the whole system, by pivots.
#pragma once

#include "contact_system.hpp"
#include "linear_factor.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

class SparseSystem : public ContactSystem {
 public:
  enum class Factors { eliminated, whole };  ///< eliminated_factor() or saddle_factor()
  /// `matrices` outlives it. `set`: over all rows of B; which of them belong together.
  SparseSystem(const SparseMatrices& matrices, const FeasibleSet& set, Factors factors = Factors::eliminated);

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

  /// Makes K u + B'x = f of a solution (x, u) hold to the figures of x, where nodes feel less than the last figure of u: by `u`
  /// and by the forces of `rows`, which share what is missing with the bodies. Returns what u lacks after its last figure.
  Eigen::VectorXd balance(std::span<const Local> rows, const Eigen::VectorXd& f, Eigen::VectorXd& x, Eigen::VectorXd& u) const;

 private:
  class Step;
  struct Moving;

  Moving moving(const Guess& guess) const;
  std::unique_ptr<LinearFactor> factor_of(const Moving& moving, bool symmetric);
  std::unique_ptr<LinearFactor> factor_of_path(BlockEquations equations, std::span<const Local> pinned) const;

  const SparseMatrices& matrices_;
  Factors factors_;
  Eigen::VectorXd diagonal_, own_;
  mutable JoinedStiffness stiffness_;  // its factors take its memory
};

}  // namespace mortise::qp
