// Whether a run may call itself solved. One function decides, from the numbers that are printed beside its sentence.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/warning.hpp"

namespace mortise::post {

/// The largest rigid motion that a body made, beyond what supports, fits and gaps account for.
struct Drift {
  double sizes = 0;  ///< over the body's size
  std::string text;  ///< `body "plate" moves along (0, 0, 1)`
};

/// How well an equilibrium is solved, each relative, as in summary.json.
struct Residuals {
  double projected_gradient = 0, equality = 0, equilibrium = 0;
  double penetration = 0;      ///< over the largest displacement
  double complementarity = 0;  ///< sum of |gap * force| over twice the strain energy
  double supports = 0;         ///< how far prescribed nodes are from where they should be, over the largest displacement
  double interfaces = 0;       ///< how far copies of a node, and bonded nodes, are from each other, over the same
};

/// What one equilibrium claims. A number that is not finite is a failure, but for error estimates, where NaN says that none was
/// made.
struct Evidence : Residuals {
  bool converged = false;  ///< which the solver alone decides, see qp::Goal and, with Coulomb's law, friction::solve_coulomb()
  std::string limit;       ///< the key of the deck that ended the solver early, or ""
  double tolerance = 0;    ///< the relative residual that the deck asks for; 0: auto
  double imbalance = 0;    ///< of all forces, over the largest: Balance::difference
  double algebraic_error = std::numeric_limits<double>::quiet_NaN();  ///< of the solver, relative, in the energy norm
  Drift drift;
};

/// What a run may say of itself.
struct Verdict {
  ExitStatus status = ExitStatus::solved;
  std::string headline;  ///< "Solved." or what it is instead
  std::string reason;    ///< a sentence with the numbers that decided and a cure; empty if solved

  bool solved() const { return status == ExitStatus::solved; }
};

/// The one place that decides the exit status of a solution. Solved: the solver converged, and no number exceeds its limit (a
/// residual: the fixed limit, or the deck's tolerance if that is larger), however far bodies move: something soft may carry them.
/// No equilibrium: a body drifts by half its size while some number does not fit. Else not converged. Depends on its argument
/// alone.
Verdict verdict(const Evidence& evidence);

/// "unreached_tolerance": of an equilibrium that is solved, the projected gradient is more than twice the `tolerance` that the
/// deck asks for (0: auto), as rounding leaves no less. `algebraic_error`: see Results.
std::vector<Warning> unreached_tolerance(const Residuals& residuals, double tolerance, double algebraic_error);

}  // namespace mortise::post
