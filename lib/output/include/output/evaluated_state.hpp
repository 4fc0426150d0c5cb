// What the writers read.
#pragma once

#include "analysis/load_step_solver.hpp"
#include "post/results.hpp"

namespace mortise::output {

/// A state that has been evaluated. Refers to its members' owners.
struct EvaluatedState {
  const partition::Decomposition& decomposition;
  const partition::Interface& interface;
  const analysis::StepState& state;
  const post::Probes& probes;
  const post::Results& results;

  const model::LoadState& acts() const { return state.rows->acts; }
};

}  // namespace mortise::output
