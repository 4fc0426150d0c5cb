// The exact projection onto C = {x : G x = e} intersected with Omega: everything about feasibility that needs no product with A.
#pragma once

#include "qp/equality.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

/// The result of project().
struct Projection {
  Vector point;         ///< in Omega; G point = e to rounding if `found`
  Eigen::VectorXd nu;   ///< multiplier of G x = e, the same on every rank; if C is empty a direction along which it runs away
  bool found = false;   ///< false: C is empty, or so nearly that the iteration did not settle
  double residual = 0;  ///< ||G point - e|| relative to ||e||, as EqualityConstraint::norm measures it
};

/// The point of C nearest to y: x = P_Omega(y - G' nu), where nu minimises the convex, once differentiable dual function
///
///     theta(nu) = 1/2 ||w||^2 - 1/2 ||w - P_Omega(w)||^2 + e'nu,   w = y - G' nu,   grad theta = e - G P_Omega(w),
///
/// by a semismooth Newton method with line search; the Jacobian G D G' differs from G G' by the active constraints only and is
/// regularised in proportion to the residual. theta is unbounded below exactly if C is empty. Collective.
Projection project(const Vector& y, const EqualityConstraint& equality, const FeasibleSet& set);

}  // namespace mortise::qp
