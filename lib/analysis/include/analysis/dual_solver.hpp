// The quadratic programmes of load steps on one dual problem: what solves them, how exactly, and when it gives up.
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

/// One load step after the other on a dual problem, which gets another right-hand side between them: recycled directions, the
/// norm and M of SMALSE-M stay. Where a contact has Coulomb's law, friction::solve_coulomb() finds its slip bounds; else they are
/// given.
class DualSolver {
 public:
  /// The problem outlives it, and is exact where the solver's products have to be (qp::SolverKind::exact_products). laws[c]: of
  /// contact c. Collective.
  DualSolver(const feti::DualProblem& problem, std::vector<friction::Law> laws, const friction::Options& loop,
             const qp::Options& solver);
  DualSolver(const DualSolver&) = delete;
  DualSolver& operator=(const DualSolver&) = delete;

  /// Solves for the multipliers, from `before`, the solution of the step before, if there is one: to the tolerance of the
  /// solver's options or, where that is auto, to what errors are compared with, `accuracy`. `patience`: when it gives up in
  /// favour of another approach; with one, it also gives up where its algorithm makes no more progress. Throws
  /// Error(no_equilibrium) that names the body that moves and how. Collective.
  feti::DualSolution solve(const std::optional<qp::Solution>& before, const qp::Goal& accuracy, const Observer& observer,
                           std::optional<qp::Patience> patience = {});
  /// The next solve may begin with states of constraints that these forces and this gradient have, see qp::Solver.
  void suggest(qp::Solution states) { algorithm_->suggest(std::move(states)); }
  /// Products with F of all solves, also of one that threw.
  int applications() const { return hessian_.count(); }

 private:
  struct Step;
  qp::Goal goal(const qp::Goal& accuracy) const;
  feti::DualSolution solve_tresca(Step& step);
  feti::DualSolution solve_coulomb(Step& step);
  void tell_unresolved_nodes(const qp::Problem& problem, const feti::StateRecord& states, feti::DualSolution& result);

  const feti::DualProblem& problem_;
  const std::vector<friction::Law> laws_;
  const friction::Options loop_;
  const std::optional<double> tolerance_;  // of the residual; without one the error decides
  const bool from_direct_;                 // a direct solution is where all begins
  qp::Hessian hessian_;
  qp::Budget budget_;
  const qp::FeasibleSet omega_;  // with the coefficients of the laws
  std::unique_ptr<qp::Solver> algorithm_;
};

}  // namespace mortise::analysis
