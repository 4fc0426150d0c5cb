// What a model and its results should make their user look at: the checks of lib/post, fed from the deck.
#pragma once

#include <vector>

#include "analysis/load_step_solver.hpp"
#include "analysis/rows.hpp"
#include "analysis/warnings.hpp"

namespace mortise::analysis {

/// Before the solution: materials, units, contacts. Collective.
std::vector<Warning> check_model(const model::Model& model, const Rows& rows, const Communicator& comm);

/// After the solution of a state: displacements, pressures, forces, the mesh's error. Collective.
std::vector<Warning> check_results(const model::Model& model, const StepState& state, const post::Results& results,
                                   const Communicator& comm);

/// Looks for bodies that no support holds and no contact reaches, and names each, the body nearest to it and the distance. Throws
/// Error(no_equilibrium) if the loads drive one of them, which nothing would stop; adds the others to `warnings`: the solver sets
/// their rigid motions to zero. Collective.
void check_unconstrained_bodies(const model::Model& model, const Rows& rows, const Context& context, Warnings& warnings);

}  // namespace mortise::analysis
