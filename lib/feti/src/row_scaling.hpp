// How rows of B are scaled, which nobody outside of this module sees: forces, lengths and slip bounds come in and go out by
// DualProblem.
#pragma once

#include "feti/jump_operator.hpp"

namespace mortise::feti {

struct RowScaling {
  /// Of each owned row: that of B over that which was given, or of gluing over that of the difference of displacements. So it
  /// scales coefficients, bounds and jumps, and makes a force of a multiplier.
  static const Eigen::VectorXd& of(const JumpOperator& jump) { return jump.scaling_; }
};

}  // namespace mortise::feti
