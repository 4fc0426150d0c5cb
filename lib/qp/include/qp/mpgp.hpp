// MPGP: modified proportioning with gradient projections, for min 1/2 x'H x - c'x over Omega alone [Dostal and Kozubek, An
// optimal algorithm and superrelaxation for minimization of a quadratic function subject to separable convex constraints, Math.
// Program. 135 (2012)]. With bounds only it is MPRGP.
#pragma once

#include <functional>

#include "qp/problem.hpp"

namespace mortise::qp {

/// y = H x; one product with the Hessian of the outer problem.
using Product = std::function<void(const Vector& x, Vector& y)>;

/// A point with its gradient.
struct Iterate {
  Vector x;
  Vector gradient;  ///< H x - c
};

/// Parameters of the method, for ||H|| = 1.
struct MpgpOptions {
  double step = 1.9;           ///< length of gradient steps, below 2 / ||H||
  double proportioning = 1.0;  ///< Gamma
};

/// Improves `point`, which must lie in Omega with its true gradient, until `done(measure, point)` says so; `measure` is the norm
/// of the reduced projected gradient (x - P_Omega(x - a g)) / a. `norm` is ||H|| as far as known and is raised when a direction
/// shows more. `done` is called once an iteration with the same arguments on all ranks. Collective.
void mpgp(const Product& hessian, const FeasibleSet& set, Iterate& point, double& norm, const MpgpOptions& options,
          const std::function<bool(double measure, const Iterate& point)>& done);

/// ||x - P_Omega(x - a g)|| / a. Collective.
double reduced_gradient(const FeasibleSet& set, const Iterate& point, double a);

}  // namespace mortise::qp
