// The quadratic programmes of load states on one dual system: what solves them, how exactly, and when it gives up.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "feti/dual_problem.hpp"
#include "feti/dual_solution.hpp"
#include "friction/law.hpp"
#include "friction/options.hpp"
#include "qp/solver.hpp"

namespace mortise::analysis {

/// One line of progress: the number of the Tresca problem, the relative change of the slip bounds before it, and where the solver
/// stands.
using Observer = std::function<void(int step, double change, const qp::Progress&)>;

/// One problem after the other of a dual system: recycled directions, the norm and M of SMALSE-M stay, and so does the
/// preconditioner, which follows the active set. Where a contact has Coulomb's law, friction::solve_coulomb() finds its slip
/// bounds; else they are given.
class DualSolver {
 public:
  /// Shares the system, whose products are exact where the solver's have to be (qp::SolverKind::exact_products). laws[c]: of
  /// contact c. Throws as feti::Preconditioner. Collective.
  DualSolver(std::shared_ptr<const feti::DualSystem> system, std::vector<friction::Law> laws, const friction::Options& loop,
             const qp::Options& solver);
  DualSolver(const DualSolver&) = delete;
  DualSolver& operator=(const DualSolver&) = delete;

  /// Solves a problem of system() for its multipliers, from `before`, the solution of the step before, if there is one: to the
  /// tolerance of the solver's options or, where that is auto, to what errors are compared with, `accuracy`. `patience`: when it
  /// gives up in favour of another approach; with one, it also gives up where its algorithm makes no more progress.
  /// `suggested`: forces and a gradient whose states of constraints it may begin with, see qp::Solver; or null. Throws
  /// Error(no_equilibrium) that names the body that moves and how. Collective.
  feti::DualSolution solve(const feti::DualProblem& problem, const std::optional<qp::Solution>& before, const qp::Goal& accuracy,
                           const Observer& observer, std::optional<qp::Patience> patience = {},
                           const qp::Solution* suggested = nullptr);
  /// Products with F of all solves, also of one that threw.
  int applications() const { return hessian_.count(); }
  const feti::DualSystem& system() const { return *system_; }
  /// F, and what its last product was made of.
  const feti::RememberedProduct& product() const { return product_; }

 private:
  struct Step;
  qp::Goal goal(const feti::DualProblem& problem, const qp::Goal& accuracy) const;
  feti::DualSolution solve_tresca(Step& step);
  feti::DualSolution solve_coulomb(Step& step);
  void tell_unresolved_nodes(const Step& step, const qp::FeasibleSet& set, const feti::StateRecord& states,
                             feti::DualSolution& result);

  const std::shared_ptr<const feti::DualSystem> system_;
  const std::vector<friction::Law> laws_;
  const friction::Options loop_;
  const std::optional<double> tolerance_;                              // of the residual; without one the error decides
  const bool from_direct_;                                             // a direct solution is where all begins
  const std::unique_ptr<qp::ActiveSetPreconditioner> preconditioner_;  // null if the options want none
  const feti::RememberedProduct product_;
  qp::Hessian hessian_;  // this, counted
  qp::Budget budget_;
  const qp::FeasibleSet omega_;  // with the coefficients of the laws
  std::unique_ptr<qp::Solver> algorithm_;
};

}  // namespace mortise::analysis
