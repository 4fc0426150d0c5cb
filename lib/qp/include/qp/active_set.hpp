// The active set that a projection has picked, and the linear algebra on the face of Omega that it leaves.
//
// Free are all unknowns without a constraint, those of a bound or a disc that the argument w lies inside of, and along a disc
// that slips (||w - centre|| > radius) the tangent alone. Where w is outside a disc by r - radius after a gradient step of length
// a, the disc bends the tangent with the curvature sigma = (r - radius) / (a radius): to second order, the quadratic function on
// the circle is that on the tangent with sigma added to its Hessian.
#pragma once

#include "qp/problem.hpp"
#include "qp/projection.hpp"

namespace mortise::qp {

/// Which constraints are active at a point, and the projectors onto what they leave free. Refers to the projector, which outlives
/// it.
class ActiveSet {
 public:
  /// The active set at `argument`, that of a projection onto `set` by `projector`, after a gradient step of length `step`;
  /// `stiffness`, one for each disc, is what curvatures are measured against. Distances from bounds below `active_set_tolerance`
  /// times the largest one count as none: bodies that touch without force, like the idle rollers of a bearing, are projected to
  /// next to nothing, and where that is free they could be given tension. `coupled`: radii follow the discs' normal unknowns;
  /// then what moves is T x, and what is felt of a gradient is what x feels, so that the active set is not symmetric.
  ///
  /// Factorizes the coarse matrices of the projector; where these are sparse it is valid until they are factorized anew. Throws
  /// Error(not_converged) if they have no factor. Collective.
  ActiveSet(Projector& projector, const FeasibleSet& set, const Vector& argument, double step, std::span<const double> stiffness,
            double active_set_tolerance, bool coupled = false);

  /// x becomes its free part Pi x: zero at constrained unknowns, along the tangent alone at discs that slip.
  void keep_free(Vector& x) const { restrict(x, 0); }
  /// y += factor (x - T d), d the free part of x: how far x leads off the constraints. T d = d + coefficient d[normal] n at discs
  /// that slip in the direction n and follow a normal unknown. No other unknowns are touched.
  void add_constrained(double factor, const Vector& x, Vector& y) const;
  /// x becomes T d + constrained with G x = 0, d nearly its free part; `constrained` as add_constrained() has it. Collective.
  void project_trial(Vector& x, const Vector& constrained) const;

  /// y += Sigma x.
  void add_curvature(const Vector& x, Vector& y) const;
  /// x = w Pi x: the free part, slip directions scaled by w = sqrt(stiffness / (stiffness + sigma)) so that bent and straight
  /// directions are alike to a preconditioner.
  void scale(Vector& x) const;

  /// x becomes the free direction x - w^2 Pi G'(G w^2 Pi G')^-1 G Pi x, for which G x = 0. Applied twice, against
  /// rounding, where it is not projected again. Collective.
  void project(Vector& x, int sweeps = 2) const { sweep(x, true, sweeps); }
  /// The transpose of project(): the part of a gradient that free directions feel. Collective.
  void project_gradient(Vector& x, int sweeps = 2) const { sweep(x, false, sweeps); }

  /// The reaction of the constraints to the gradient x: x becomes x + G'nu with the nu that leaves least of it to free
  /// directions. Returns what is left of it at the free unknowns that have no curvature. Collective.
  Vector reduce(Vector& x) const;

  /// Whether on any rank discs that slip follow their normal unknowns: then project_trial() is another projection than project().
  bool coupled() const { return trial_factor_.has_value(); }
  /// Unknowns of this rank that are not free at all, and pairs that are along a tangent alone.
  const std::vector<Local>& fixed() const { return fixed_; }
  const std::vector<SlipDirection>& slips() const { return slips_; }

  long long active_bounds = 0;  ///< bounds on this rank that hold their unknown
  long long slipping = 0;       ///< discs on this rank that slip or are pinned

 private:
  struct Coupling {
    Local normal;
    std::array<Local, 2> index;
    Eigen::Vector2d direction;  // coefficient n
  };
  void extend(Vector& x) const;               // x = T x
  void extend_transpose(Vector& x) const;     // x = T' x, but for restrict()
  void restrict(Vector& x, int power) const;  // x = w^power Pi x; power: 0, 1, 2 or -2
  void sweep(Vector& x, bool direction, int sweeps) const;

  const EqualityConstraint& equality_;
  std::vector<Local> fixed_;
  std::vector<SlipDirection> slips_;
  std::vector<double> weights_;  // of each of these: w
  std::vector<Coupling> couplings_;
  // Of the coarse matrix of w^2 Pi, which the constructor makes in any case; of that of T w^2 T', unless nothing is coupled.
  std::optional<CoarseMatrix::Factor> factor_, trial_factor_;
};

}  // namespace mortise::qp
