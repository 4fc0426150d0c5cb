// SMALSE-M: semimonotonic augmented Lagrangians for separable constraints and equalities [Dostal, Kozubek et al., Scalable Domain
// Decomposition Algorithms for Contact Problems, DD20, section 5]. With bounds only it is SMALBE-M. See lib/qp/README.md.
#pragma once

#include <optional>

#include "qp/options.hpp"
#include "qp/problem.hpp"

namespace mortise::qp {

/// What a solve leaves, and what the next one of a sequence may start from.
struct Solution {
  Solution(const Vector& point, const Vector& at_point, const Eigen::VectorXd& multipliers)
      : x(point, Teuchos::Copy), gradient(at_point, Teuchos::Copy), nu(multipliers)
  {
  }

  Vector x;            ///< in Omega up to the equality residual
  Vector gradient;     ///< A x - b
  Eigen::VectorXd nu;  ///< multipliers of G x = e: A x - b + G' nu lies in the normal cone of -Omega; same on all ranks
  bool converged = false;
  bool feasible = true;  ///< false: {G x = e} and Omega do not meet; nu is then a direction that proves it, x is not solved for
  int outer_iterations = 0;
  double projected_gradient = 0;  ///< relative to ||P b||
  double equality = 0;            ///< relative, ||Q x - Q x_e|| / ||P b|| in the scaling ||P A P|| = 1

  double hessian_norm = 0;    ///< ||P A P||, kept from solve to solve
  double precision = 1;       ///< M, kept from solve to solve
  Eigen::VectorXd augmented;  ///< multipliers mu of the augmented Lagrangian, kept from solve to solve
};

/// Solves the problem to `tolerance` from `start`, or from the feasible point nearest to 0. Collective.
Solution smalse(const Problem& problem, const std::optional<Solution>& start, double tolerance, const Observer& observer);

}  // namespace mortise::qp
