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

/// A solved load state, from which the next one starts. A value.
struct StepState {
  std::shared_ptr<const Rows> rows;
  std::shared_ptr<const post::SymmetricNodes> symmetric;
  feti::DualSolution solved;
  std::vector<Eigen::VectorXd> displacement;  ///< of each subdomain
  std::vector<double> shortenings;            ///< of the preloaded contacts, lengths
  std::optional<qp::Patience> patience;       ///< when the next load step gives up
  Magnitudes before;                          ///< of the states before this one
};

/// The dual problem of a load state, and the rows that it is of. Heavy: moves, does not copy.
struct StepProblem {
  std::shared_ptr<const Rows> rows;
  std::shared_ptr<const post::SymmetricNodes> symmetric;
  std::unique_ptr<feti::DualProblem> dual;
};

/// What the first load step is to find, multipliers lambda of the rows of B, see feti::DualProblem:
///
///     minimise  1/2 lambda'F lambda - lambda'd   subject to  G lambda = e,  lambda in Omega.
///
/// The assembly outlives it. Throws Error(no_equilibrium), naming the body and its motion, if loads drive a body that nothing
/// holds. Collective.
StepProblem make_dual_problem(const Assembly& assembly, Rows rows, const Context& context);

/// Heavy: neither copies nor moves.
class LoadStepSolver {
 public:
  /// `first`: the problem of the first state. The assembly outlives it. Collective.
  LoadStepSolver(const Assembly& assembly, StepProblem first, Approach approach, const Context& context);
  LoadStepSolver(const LoadStepSolver&) = delete;
  LoadStepSolver& operator=(const LoadStepSolver&) = delete;

  /// Finds the equilibrium of the state `acts`: first that of the constructor's problem, with nothing for `before`; then one
  /// state after the other, each with what the call before returned, from which friction counts slip. Throws
  /// Error(no_equilibrium). Collective.
  StepState solve(const model::LoadState& acts, std::optional<StepState> before, const Observer& observer);

  /// The same without solving: takes the solution from the record of an earlier run. Throws as solution_of(). Collective.
  StepState take_up(const model::LoadState& acts, std::optional<StepState> before, const Record& record);

  /// What comes of a state in which products gave up, the last one. Collective.
  Outcome given_up(const StepState& state) const;

  /// The dual problem of the last state; replaced by another one when rows change.
  const feti::DualProblem& problem() const { return *problem_; }
  /// Products with F of all load steps and of the earlier approaches, also of a load step that threw.
  int applications() const { return before_ + (solver_ ? solver_->applications() : 0); }

 private:
  /// In the energy norm: the estimated error of the mesh; the size of what is strained, but a thousandth of the whole at least;
  /// the whole, with what springs store: of a body that hangs on springs they may have all of it.
  struct Norms {
    double error = 0, size = 0, whole = 0;
  };
  Norms norms(std::span<const fem::Constitution> constitution, const Vector& lambda,
              const std::vector<Eigen::VectorXd>& displacement) const;
  void make_solver();
  void take_rows(Rows rows);
  Magnitudes up_to(const StepState& state) const;
  void update(const model::LoadState& acts, StepState& from);

  const Assembly& assembly_;
  const Context& context_;
  const Approach approach_;
  std::shared_ptr<const Rows> rows_;  // of the problem
  std::shared_ptr<const post::SymmetricNodes> symmetric_;
  std::unique_ptr<feti::DualProblem> problem_;
  std::optional<DualSolver> solver_;  // refers to the problem
  bool first_ = true;                 // no state has been solved yet
  int before_ = 0;                    // products of the solvers and approaches before this one
};

/// All results of the state that solver.solve() or take_up() returned last, also inside bodies where `probes` are. Throws
/// Error(no_equilibrium) if the verdict says that it is no equilibrium. Collective.
post::Results evaluate(const Assembly& assembly, const LoadStepSolver& solver, const StepState& state, const post::Probes& probes,
                       const Context& context);

}  // namespace mortise::analysis
