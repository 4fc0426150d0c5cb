// history.csv, a row for each outer iteration, and the line that moves while it iterates.
#pragma once

#include <string>

#include "base/context.hpp"
#include "model/deck.hpp"
#include "qp/options.hpp"
#include "qp/solution.hpp"

namespace mortise {

class History {
 public:
  /// Refers to its arguments.
  History(const qp::Options& options, const Context& context) : options_(options), context_(context) {}

  /// Ends the run here if a signal asked for that. Collective.
  void note(const model::LoadState& state, int step, double change, const qp::Progress& p);
  const std::string& text() const { return text_; }

 private:
  const qp::Options& options_;
  const Context& context_;
  long long inner_ = 0;  // calls within outer iterations, the same on all ranks
  std::string active_;   // contact nodes of all ranks at the end of the last outer iteration
  std::string text_ =
      "stage,friction_step,outer_iteration,hessian_multiplications,preconditionings,projected_gradient,equality,slip_bound_"
      "change,precision,open,"
      "slipping,time,dual_energy,error\n";
};

}  // namespace mortise
