// How far a point is from the solution, judged afterwards.
#pragma once

#include "qp/solution.hpp"

namespace mortise::qp {

/// About ||x - x*|| in the norm of A: sqrt(r'Mr) of the natural residual r = (x - P_C(x - a g)) / a, a = 1 / ||P A P||. FETI's
/// preconditioners M have M A >= 1 on its multipliers, which makes it a bound where no constraint changes [Tezaur, PhD thesis,
/// 1998]; without one (null) M is 1 / ||P A P||. Costs no product with A. Collective.
double error_estimate(const Problem& problem, const Solution& solution, const Operator* preconditioner);

}  // namespace mortise::qp
