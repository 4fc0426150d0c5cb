// Friction: where the slip bounds of the contact points come from, and the fixed point that Coulomb's law needs.
//
// Tresca: the bound of a point is a given traction times its area; one quadratic programme gives the answer. Coulomb: the bound
// is the coefficient times the point's normal force, which is found by repeating Tresca problems, each solved only as exactly as
// the bounds are known and started from the one before. Face Newton renews the bounds at each of its faces instead, and falls
// back to the fixed point where that does not settle. The first step lets every Coulomb point stick, so that a floating body that
// is pushed sideways has an equilibrium from the start.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "feti/dual_problem.hpp"
#include "friction/options.hpp"
#include "qp/face_newton.hpp"
#include "qp/options.hpp"

namespace mortise::friction {

/// The law of one contact. To add a law: a value here and its bound in slip_bounds().
struct Law {
  enum class Kind { frictionless, tresca, coulomb } kind = Kind::frictionless;
  double value = 0;  ///< tresca: traction; coulomb: coefficient
};

/// Radii of the discs in the scaled unknowns of `problem`, from the multipliers `lambda`; without lambda Coulomb points stick.
/// laws[c] is that of contact c.
std::vector<double> slip_bounds(const feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda);

struct Result {
  qp::Solution solution;
  int steps = 1;      ///< Tresca problems solved
  double change = 0;  ///< relative, of the slip bounds in the last step
  bool converged = false;
  std::string limit = {};  ///< the key of the deck that ended it before, if one did
  int multiplications = 0;
  int preconditionings = 0;
  int outer_iterations = 0;  ///< of all Tresca problems
};

/// One line of progress: the Tresca step, the change of the bounds before it, and where the solver stands.
using Observer = std::function<void(int step, double change, const qp::Progress&)>;

/// The algebraic error in the energy norm that is good enough at the multipliers lambda and nu, see qp::Goal.
using AllowedError = std::function<double(const Vector& lambda, const Eigen::VectorXd& nu)>;

/// Solves for the multipliers, to the tolerance of `solver` or, where that is auto, to the allowed error. Throws
/// Error(no_equilibrium) that names the body that moves and how. Collective.
Result solve(feti::DualProblem& problem, const std::vector<Law>& laws, const Options& options, const qp::Options& solver,
             const AllowedError& allowed_error, const Observer& observer);

}  // namespace mortise::friction
