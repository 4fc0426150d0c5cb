// The multipliers of one load step, and what it took to find them.
#pragma once

#include <string>
#include <vector>

#include "feti/unresolved_nodes.hpp"
#include "qp/solution.hpp"

namespace mortise::feti {

struct DualSolution {
  qp::Solution solution;
  std::vector<double> slip_bounds = {};   ///< of each disc of DualProblem::set(), forces: infinite where it sticks
  int steps = 1;                          ///< Tresca problems solved
  double change = 0;                      ///< relative, of the slip bounds in the last step
  bool converged = false;                 ///< as qp::Goal has it, and slip bounds, if they follow, are at rest
  std::string limit = {};                 ///< the key of the deck that ended it early, if one did, and a remark
  bool gave_up = false;                   ///< patience ended first: another approach is to go on
  int applications = 0;                   ///< products with F, of this load step
  int preconditionings = 0;               ///< of this load step
  int outer_iterations = 0;               ///< of all Tresca problems
  std::vector<Undecided> undecided = {};  ///< points whose state is not known
  std::vector<Stuck> stuck = {};          ///< where it made no progress, if it did not converge
};

}  // namespace mortise::feti
