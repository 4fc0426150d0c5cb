// Bounds of the error of a point, in the energy norm, from its residual; and whether they let it pass for a solution.
#pragma once

#include "qp/projection.hpp"
#include "qp/solution.hpp"

namespace mortise::qp {

/// An upper bound of ||x - x*||_A at a point x of C, from `natural`, the projection of x - gradient / norm onto C: with
/// r = norm (x - natural.point) and the slackness s = (gradient + G'nu - r)'(x - natural.point), both zero at a solution, the
/// error e fulfils ||e||^2 <= r'e + s, and r'e <= ||r|| ||e|| with preconditioner->energy(r) for ||r||^2 [Prager and Synge,
/// Q. Appl. Math. 5 (1947): r are gaps, and what closes them makes displacements that are compatible]. Discs of friction count
/// with the radii that they have. Without a preconditioner r'r / norm stands for ||r||^2, an estimate from below. Calls
/// preconditioner->fix(). Collective.
double error_bound(const Problem& problem, const Vector& x, const Projection& natural, double norm,
                   ActiveSetPreconditioner* preconditioner);

/// The same of a solution whose `gradient` and `hessian_norm` are set. Collective.
double error_bound(const Problem& problem, const Solution& solution, ActiveSetPreconditioner* preconditioner);

/// The square root of what rounding may make of energies with the linear term b, `norm` as above: errors below it are none.
/// Collective.
double rounding_of_error(const Vector& b, double norm);

/// Whether a small residual at the point x with the multipliers nu is to be believed beside this error: one below `rounding`, or
/// below Goal::credible times the energy norm. `finest`: the residual itself is rounding. True where the goal has no energy norm,
/// and for infinite errors, which are those of points that stick without a limit for want of slip bounds. Collective.
bool believable(double error, double rounding, const Vector& x, const Eigen::VectorXd& nu, const Goal& goal, bool finest = false);

/// Whether a solution whose error is small enough has a residual that goes with that: below
/// limits::Every::largest_residual, or with a believable error beside it. Collective.
bool fits(const Solution& solution, const Goal& goal);

}  // namespace mortise::qp
