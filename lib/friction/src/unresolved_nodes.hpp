// Which contact nodes a solve leaves open, and at which it got stuck.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "feti/dual_problem.hpp"
#include "friction/unresolved_nodes.hpp"
#include "qp/solution.hpp"
#include "state_record.hpp"

namespace mortise::friction {

/// Change of a pressure over the largest of the contact that decides nothing.
inline constexpr double negligible_change = 1e-4;

/// The states of this rank's points at multipliers x in Omega, which is `set`; forces of 1e-8 of the largest multiplier are none.
/// Bonded points stick. Collective.
std::vector<ContactStatus> states_at(const feti::DualProblem& problem, const qp::FeasibleSet& set, const Vector& x);

/// What is known of the multipliers of the solution beside x: `argument`, the projection of which onto Omega is x but for the
/// residual, tells by its distance from the border of a half-line or a disc how firmly a state is decided; `change` is about what
/// x is off by.
struct PredictedSolution {
  Vector argument, change;
};

/// By what `preconditioner` makes of the natural residual of a solution; nothing if its projection fails. No product. Collective.
std::optional<PredictedSolution> predict(const feti::DualProblem& problem, const qp::FeasibleSet& set,
                                         const qp::Solution& solution, qp::ActiveSetPreconditioner& preconditioner);

/// Contacts with points that `change` may carry across the border, one after the other. Points whose change is next to nothing
/// beside the largest pressure of the contact count as decided. The same on every rank. Collective.
std::vector<Undecided> undecided(const feti::DualProblem& problem, const qp::FeasibleSet& set, const Vector& x,
                                 const PredictedSolution& predicted);

/// Where a solve is stuck that did not converge: points whose state went there and back, or if none did, that changed, or if none
/// did, with the largest change of force still to come (`predicted`, if it is known). The same on every rank. Collective.
std::vector<Stuck> stuck(const feti::DualProblem& problem, const StateRecord& record, const Vector& x,
                         const PredictedSolution* predicted);

struct Place {
  Point at;
  bool open;  ///< not decided
};
/// The widest band of open points, in cells, from one point to the next: 2 where one row is open between decided points, 1 more
/// for each further row. At up to some hundred of them, across the band, which is the way where it is narrowest.
int widest_band(std::span<const Place> points);

}  // namespace mortise::friction
