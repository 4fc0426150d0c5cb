// The exact projection onto C = {x : G x = e} intersected with Omega: everything about feasibility that needs no product with A.
#pragma once

#include <utility>

#include "base/lazy.hpp"
#include "qp/coarse_matrix.hpp"

namespace mortise::qp {

/// The result of a projection.
struct Projection {
  Vector point;         ///< in Omega; G point = e to rounding if `found`
  Vector argument;      ///< w = y - G' nu, of which `point` is the projection onto Omega: it tells the active constraints
  Eigen::VectorXd nu;   ///< multiplier of G x = e, the same on every rank; if C is empty a direction along which it is unbounded
  bool found = false;   ///< false: C is empty, or so nearly empty that the iteration did not converge
  bool empty = false;   ///< not found, and nu proves that C is empty: its points would be a million times larger than e and y
  double residual = 0;  ///< ||G point - e|| relative to ||e|| and ||y||, as EqualityConstraint::norm measures it
};

/// Projects onto C: x = P_Omega(w), w = y - G' nu, where nu minimises the convex, once differentiable dual function
///
///     theta(nu) = 1/2 ||w||^2 - 1/2 ||w - P_Omega(w)||^2 + e'nu,   grad theta = e - G P_Omega(w),
///
/// by a semismooth Newton method with line search; the Jacobian G D G' differs from G G' by the active constraints only and is
/// regularised in proportion to the residual. theta is unbounded below exactly if C is empty. Only the constrained unknowns are
/// touched between the first step and the last: on all others P_Omega is the identity, and G G' says what nu does there.
class Projector {
 public:
  /// `equality` outlives it. `set`: one over the unknowns of those that will be projected on. Collective.
  Projector(const EqualityConstraint& equality, const FeasibleSet& set);

  /// The point of C nearest to y = `from`, from the multiplier `start` (0 if empty). Collective.
  Projection operator()(const Vector& from, const Eigen::VectorXd& e, const FeasibleSet& set, const Eigen::VectorXd& start = {});

  /// Looks for a multiplier that proves that C is empty where the iteration ended without one, since little of e is out of reach:
  /// more than 1e-8 of it, along a direction that constraints do not feel but for rounding. Returns whether there is one;
  /// failed.nu is it then. Dear: for the last word on a programme. Collective.
  bool prove_empty(const Eigen::VectorXd& e, const FeasibleSet& set, Projection& failed);

  /// The matrix G D G', which a caller may factorize for its own purposes between two projections.
  CoarseMatrix& matrix() { return matrix_; }
  /// A second one, in which discs are downdated together with their normal unknowns; made at the first call. Collective.
  CoarseMatrix& trial_matrix() { return trial_matrix_.get(); }
  const EqualityConstraint& equality() const { return equality_; }

 private:
  struct Evaluation;
  struct Given;
  Evaluation evaluate(const Given& y, Eigen::VectorXd nu) const;
  double search(const Evaluation& now, const Evaluation& full, const Eigen::VectorXd& direction,
                const FeasibleSet& compact) const;
  Evaluation minimise(const Given& y, Eigen::VectorXd nu);
  void repair(const Vector& from, const Given& y, Evaluation now, Projection& result);
  Eigen::VectorXd towards_least_residual(const Eigen::VectorXd& e, const FeasibleSet& set);
  std::pair<double, double> work_and_feeling(const Eigen::VectorXd& e, const FeasibleSet& set, const Eigen::VectorXd& nu,
                                             const Vector& like) const;

  const EqualityConstraint& equality_;
  std::vector<Local> constrained_;  // unknowns of this rank
  SparseMatrix columns_;            // G over them
  CoarseMatrix matrix_;
  Lazy<CoarseMatrix> trial_matrix_;
};

/// The point of C nearest to y, by a projector for this one use. Collective.
Projection project(const Vector& y, const EqualityConstraint& equality, const Eigen::VectorXd& e, const FeasibleSet& set);

}  // namespace mortise::qp
