// One equilibrium after the other on one assembly. Multipliers, slip and recycled directions go from each to the next.
#pragma once

#include <memory>
#include <optional>

#include "analysis/approach.hpp"
#include "analysis/assembly.hpp"
#include "analysis/carried_contact.hpp"
#include "analysis/dual_solver.hpp"
#include "analysis/restart.hpp"
#include "analysis/rows.hpp"
#include "feti/displacements.hpp"
#include "post/results.hpp"

namespace mortise::analysis {

/// How large things are in the load states so far, 0 in none: what the next one is measured by.
struct Magnitudes {
  post::Rounding rounding;  ///< what counts as rounding
  double force = 0;         ///< ||B'lambda||, the largest
  double energy_norm = 0;   ///< what springs store included, the largest
  double slip_error = 0;  ///< the solver's errors, in the energy norm, with which slip was counted, their sum; 0 without friction

  /// An energy norm that counts as none, see qp::Goal::negligible.
  double negligible() const { return 1e-8 * energy_norm; }
  /// A force that counts as none.
  double unfelt() const { return 1e-8 * force; }
};

/// A load state that is to be solved: the rows of B, the programme, and what is known from the state before. A value, whose large
/// parts are shared.
struct StepProblem {
  std::shared_ptr<const Rows> rows;
  std::shared_ptr<const post::SymmetricNodes> symmetric;
  feti::DualProblem dual;                  ///< its constraints are those of `rows`
  std::optional<qp::Patience> patience;    ///< when it gives up
  std::optional<qp::Solution> start = {};  ///< from the state before
  Magnitudes before = {};                  ///< of the states before this one
  bool first = true;                       ///< there are none
};

/// A solved load state: all that evaluate() and the next state ask for, whatever was solved after it. A value, whose large parts
/// are shared.
struct StepState {
  std::shared_ptr<const Rows> rows;
  std::shared_ptr<const post::SymmetricNodes> symmetric;
  feti::DualProblem problem;
  feti::DualSolution solved;
  std::vector<Eigen::VectorXd> displacement;  ///< of each subdomain
  std::vector<double> shortenings;            ///< of the preloaded contacts, lengths
  std::optional<qp::Patience> patience;       ///< when the next load step gives up
  Magnitudes before;                          ///< of the states before this one
  bool first = true;                          ///< there are none
};

/// What the first load step is to find, multipliers lambda of the rows of B, see feti::DualProblem:
///
///     minimise  1/2 lambda'F lambda - lambda'd   subject to  G lambda = e,  lambda in Omega.
///
/// The assembly outlives it and what is made of it. `approach`: that of the solver which it is for. Throws
/// Error(no_equilibrium), naming the body and its motion, if loads drive a body that nothing holds. Collective.
StepProblem make_dual_problem(const Assembly& assembly, Rows rows, const Approach& approach, const Context& context);

/// Keeps what is known of F: recycled directions and norms, as long as states have the same system. All else is in the states.
/// Heavy: neither copies nor moves.
class LoadStepSolver {
 public:
  /// Prepares for problems of the system of `first`. The assembly outlives it. Collective.
  LoadStepSolver(const Assembly& assembly, const StepProblem& first, Approach approach, const Context& context);
  LoadStepSolver(const LoadStepSolver&) = delete;
  LoadStepSolver& operator=(const LoadStepSolver&) = delete;

  /// The problem of the state `acts` after `before`, from whose end friction counts slip and whose solution is its start. On the
  /// system of `before` as long as its rows stay. Throws Error(no_equilibrium) as make_dual_problem(). Collective.
  StepProblem problem_after(StepState before, const model::LoadState& acts);

  /// Finds the equilibrium. Throws Error(no_equilibrium). Collective.
  StepState solve(StepProblem problem, const Observer& observer);

  /// The same without solving: takes the solution from the record of an earlier run. Throws as solution_of(). Collective.
  StepState take_up(StepProblem problem, const Record& record);

  /// No state comes after the last one: all that solved it goes, in favour of what is recovered from it.
  void let_go() { drop_solver(); }

  /// What comes of a state in which products gave up, the last one. Collective.
  Outcome given_up(const StepState& state) const;

  /// Products with F of all load steps and of the earlier approaches, also of a load step that threw.
  int applications() const { return before_ + (solver_ ? solver_->applications() : 0); }

 private:
  /// In the energy norm: the estimated error of the mesh; the size of what is strained, but a thousandth of the whole at least;
  /// the whole, with what springs store: of a body that hangs on springs they may have all of it.
  struct Norms {
    double error = 0, size = 0, whole = 0;
  };
  Norms norms(const post::SymmetricNodes& symmetric, const feti::DualProblem& problem,
              std::span<const fem::Constitution> constitution, const Vector& lambda,
              const std::vector<Eigen::VectorXd>& displacement) const;
  void drop_solver();
  DualSolver& solver_of(const feti::DualProblem& problem);
  qp::Goal goal(const StepProblem& problem, std::span<const fem::Constitution> constitution,
                feti::Displacements& displacements) const;
  Magnitudes up_to(const StepState& state) const;
  StepState end(StepProblem problem, feti::DualSolution found, std::vector<Eigen::VectorXd> displacement) const;

  const Assembly& assembly_;
  const Context& context_;
  const Approach approach_;
  std::optional<DualSolver> solver_;  // of the last system
  int before_ = 0;                    // products of the solvers and approaches before this one
};

/// All results of a state on this assembly, also inside bodies where `probes` are. Throws Error(no_equilibrium) if the verdict
/// says that it is no equilibrium. Collective.
post::Results evaluate(const Assembly& assembly, const StepState& state, const post::Probes& probes, const Context& context);

}  // namespace mortise::analysis
