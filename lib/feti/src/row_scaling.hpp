// How rows of B are scaled, which nobody outside of this module sees: forces, lengths and slip bounds come in and go out by
// DualProblem.
#pragma once

#include <vector>

#include "feti/jump_operator.hpp"

namespace mortise::feti {

/// An additional equality row given in terms of subdomains: coefficients over all unknowns of this rank's subdomains (empty
/// vectors where it has none). The row stands on the rank of the lowest subdomain that has it. `scale`: that of the row over
/// one in lengths, the same on all ranks.
struct SubdomainRow {
  std::vector<Eigen::VectorXd> coefficients;
  double scale = 1;
};

struct RowScaling {
  /// Of each owned row: that of B over that which was given, or of gluing over that of the difference of displacements. So it
  /// scales coefficients, bounds and jumps, and makes a force of a multiplier.
  static const Eigen::VectorXd& of(const JumpOperator& jump) { return jump.scaling_; }

  /// How far each owned row, as scaled, gives way under its multiplier: F gets these on its diagonal. Rows between contact nodes
  /// give way as a node does, for without it they depend on those of the nodes; and so do rows without entries, of friction
  /// between what supports hold. The others do not.
  static const Eigen::VectorXd& compliance_of(const JumpOperator& jump) { return jump.compliance_; }
};

}  // namespace mortise::feti
