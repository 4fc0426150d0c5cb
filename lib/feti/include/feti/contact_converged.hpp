// Whether an unfinished solution knows its contacts.
#pragma once

#include "feti/dual_problem.hpp"

namespace mortise::feti {

/// Whether contact has converged at the multipliers x, from which those of the solution differ by about `change`: pressures and
/// tractions of every contact are known to 5 % of its largest pressure, and of its points at most a tenth of a row around what
/// presses do not know whether they do: those whose `argument`, see Goal::contact_converged, is nearer to 0 than `change`.
/// Collective.
bool contact_converged(const DualProblem& problem, const Vector& x, const Vector& argument, const Vector& change);

/// Whether the normal force of every contact is known to a tenth at the multipliers x, from which those of the solution differ by
/// about `change`. For runs whose residual is given: it bounds what is left of all loads, and a contact may carry less than that.
/// Forces below a thousandth of the least load of a body do not matter. Collective.
bool contact_forces_known(const DualProblem& problem, const Vector& x, const Vector& change);

}  // namespace mortise::feti
