// Whether an unfinished solution knows its contacts.
#pragma once

#include "feti/dual_problem.hpp"

namespace mortise::friction {

/// Whether contact is settled at the multipliers x, from which those of the solution differ by about `change`: pressures and
/// tractions of every contact are known to 5 % of its largest pressure, and all points but a row around what presses know
/// whether they do: `argument`, see Goal::settled, is farther from 0 than `change`. Collective.
bool contact_settled(const feti::DualProblem& problem, const Vector& x, const Vector& argument, const Vector& change);

}  // namespace mortise::friction
