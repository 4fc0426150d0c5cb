// SMALSE-M: semimonotonic augmented Lagrangians for separable constraints and equalities [Dostal, Kozubek et al., Scalable Domain
// Decomposition Algorithms for Contact Problems, DD20, section 5]. With bounds only it is SMALBE-M. See lib/qp/README.md.
#pragma once

#include <optional>

#include "qp/solution.hpp"

namespace mortise::qp {

/// Solves the problem to `tolerance`, relative to ||P b||, from `start`, or from the feasible point nearest to 0. Not converged
/// if the products of problem.hessian run out. Collective.
Solution smalse(const Problem& problem, const std::optional<Solution>& start, double tolerance, const Observer& observer);

}  // namespace mortise::qp
