// Whether forces within the law of friction balance the loads at all. Each `set` is Omega with the law's coefficients.
#pragma once

#include <optional>

#include "feti/no_equilibrium.hpp"
#include "friction/law.hpp"
#include "qp/projection.hpp"
#include "qp/solution.hpp"

namespace mortise::friction {

/// Forces that bounds just allowed may be more than the law allows, by what bounds and normal forces still differ by. That counts
/// as error; and where no forces within the law balance the loads there is no equilibrium, however little they lack. One product.
/// Throws as feti::no_equilibrium(). Collective.
void judge_by_law(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws,
                  qp::Hessian& hessian, qp::Solution& solution);

/// Where forces within the law balance the loads, but those that the bodies' stiffness asks for never do: throws as
/// feti::no_equilibrium() if those at x fall short by more than 5 %, or where the normal forces hardly answer to the bounds by
/// more than 0.2 %: `response` is the part of a change of bounds that their answer changes by, if it is known. Collective.
void refuse_if_far(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws, const Vector& x,
                   const std::optional<double>& response);

/// Throws as feti::no_equilibrium() if bodies slide on for ever with the forces x (qp::Solution::slides), whose normal forces
/// slip changes no more, and friction falls short by more than a ten-thousandth. Collective.
void refuse_if_sliding(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws,
                       const Vector& x);

/// Whether discs of these radii leave forces that balance the loads, to a thousandth. What a solution at other bounds would still
/// change by does not tell it: where all slips, no stiffness resists. Collective.
bool balances(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<double>& radii, const Vector& x);

}  // namespace mortise::friction
