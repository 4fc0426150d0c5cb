// What one load step holds on its way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "friction/friction.hpp"
#include "state_record.hpp"

namespace mortise::friction {

struct Solver::Run {
  std::shared_ptr<const qp::RightHandSide> right;
  qp::Goal goal;
  qp::Observer watch;
  std::optional<qp::Patience> patience;
  StateRecord states;                         // of contact nodes
  std::vector<double> radii, previous_radii;  // of discs, see DualProblem::radii(): those that come next, and before
  std::vector<double> at_work;                // those of the last problem that was solved, or tried
  std::optional<qp::Solution> solution;       // at first that of the load step before
  bool solved = false;                        // `solution` is of this load step
  Eigen::VectorXd escape;                     // nu of the last Tresca problem that was infeasible,
  bool proven = false;                        // and whether it proves that
  double change = 1, least_change = 1;
  bool any_answer = false;               // of a Tresca problem,
  std::vector<double> answered, answer;  // its last radii, and those that its solution asks for; maybe none on this rank
  double response = 1;                   // how much of a change of bounds the normal forces answer with; 1: unknown
  int step = 0, outer = 0, preconditionings = 0;
  bool converged = false;
  std::string limit;  // of products, that ended it

  void count(const qp::Solution& found)
  {
    outer += found.outer_iterations;
    preconditionings += found.preconditionings;
  }
};

}  // namespace mortise::friction
