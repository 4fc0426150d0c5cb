// What is said where no multipliers balance the loads.
#pragma once

#include "feti/dual_problem.hpp"
#include "qp/projection.hpp"

namespace mortise::feti {

/// Whether the forces nearest to the loads fall short of them by more than a search that does not converge leaves: then there is
/// no equilibrium, proven or not.
bool fall_short(const qp::Projection& nearest);

/// Throws that no forces balance the loads, and which body moves how along `nu`. `proven`: `nu` proves it, Error(no_equilibrium);
/// else the search for such forces just did not converge, Error(bad_input). Collective.
[[noreturn]] void no_equilibrium(const DualProblem& problem, const Eigen::VectorXd& nu, bool proven);

/// The same where a search in `set` that ended with `escape` found none: how much those nearest to the loads lack decides, unless
/// `proven`. Collective.
[[noreturn]] void nothing_found(const DualProblem& problem, const qp::FeasibleSet& set, const Eigen::VectorXd& escape,
                                bool proven);

}  // namespace mortise::feti
