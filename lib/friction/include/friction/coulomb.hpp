// Coulomb's law: the slip bound of a point is the coefficient times its normal force, which is not known before.
//
// A solver that can follow a slip law by itself (qp::SlipLaw) finds bounds and forces together. The fixed point repeats Tresca
// problems, each solved only as exactly as the bounds are known and started from the one before. The first step lets every point
// stick, so that a floating body that is pushed sideways has an equilibrium from the start.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "feti/dual_problem.hpp"
#include "feti/dual_solution.hpp"
#include "friction/law.hpp"
#include "friction/options.hpp"
#include "qp/solver.hpp"

namespace mortise::friction {

/// One line of progress: the number of the Tresca problem, the relative change of the slip bounds before it, and where the solver
/// stands.
using Observer = std::function<void(int step, double change, const qp::Progress&)>;

/// The contact problem of one load step. Refers to its parts; they outlive it.
struct CoulombProblem {
  const feti::DualProblem& dual;
  const std::vector<Law>& laws;  ///< of each contact
  const qp::FeasibleSet& omega;  ///< Omega with the coefficients of the laws
  const qp::RightHandSide& right;
  qp::Goal goal;
  Options options;
  const std::optional<qp::Solution>& before;  ///< the solution of the load step before
  const std::optional<qp::Solution>& start;   ///< this, or what the algorithm knows better
};

/// By what it is solved. Refers to its parts; they outlive it.
struct CoulombMeans {
  qp::Solver& algorithm;  ///< of the programme with Omega
  qp::Hessian& hessian;
  qp::Budget& budget;
  qp::Foreknown* known = nullptr;  ///< what the algorithm found when it began, see qp::Solver::begin()
};

/// What is tried after bounds and forces together did not converge.
struct CoulombWays {
  bool fixed_point = true;  ///< Tresca problems until their bounds are at rest, from there; always where nothing was found
  bool cautiously = true;   ///< last: once more together, by steps that may be shortened
};

struct CoulombSolution {
  feti::DualSolution found;  ///< without its slip bounds and products
  std::vector<double>
      radii;  ///< slip bounds of the last problem that was solved or tried, as radii of discs: see DualProblem::radii()
};

/// Forces that obey the law. Throws Error(no_equilibrium) that names the body that moves and how where no such forces balance the
/// loads. Collective.
CoulombSolution solve_coulomb(const CoulombProblem& problem, const CoulombMeans& means, const CoulombWays& ways,
                              const Observer& observer);

}  // namespace mortise::friction
