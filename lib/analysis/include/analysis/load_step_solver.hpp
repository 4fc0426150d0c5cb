// One equilibrium after the other on one assembly. Multipliers, slip, and what was learnt about F go from each to the next.
#pragma once

#include <memory>
#include <optional>

#include "analysis/approach.hpp"
#include "analysis/assembly.hpp"
#include "analysis/restart.hpp"
#include "analysis/rows.hpp"
#include "friction/friction.hpp"
#include "post/results.hpp"

namespace mortise::analysis {

/// An equilibrium. A value: the next load step starts from it.
struct StepState {
  std::shared_ptr<const Rows> rows;
  friction::Result solved;
  std::vector<Eigen::VectorXd> displacement;  ///< of each subdomain
  std::vector<double> shortenings;            ///< of the preloaded contacts
};

/// Heavy: neither copies nor moves.
class LoadStepSolver {
 public:
  /// The dual problem of `first`. The assembly and the approach outlive it: approach.spent has its products once it is gone.
  /// Throws Error(no_equilibrium), naming the body and its motion, if loads drive a body that nothing holds. Collective.
  LoadStepSolver(const Assembly& assembly, Rows first, Approach& approach, const Context& context);
  ~LoadStepSolver() { approach_.spent = applications(); }
  LoadStepSolver(const LoadStepSolver&) = delete;
  LoadStepSolver& operator=(const LoadStepSolver&) = delete;

  /// Finds an equilibrium: that of the constructor's rows first, then of others, each from what the call before returned;
  /// friction counts slip from there. Throws Error(no_equilibrium). Collective.
  StepState solve(const model::LoadState& acts, std::optional<StepState> before, const friction::Observer& observer);

  /// The same without solving: what a run before has found. Collective.
  StepState take_up(const model::LoadState& acts, std::optional<StepState> before, const Record& record);

  /// That of the last state; another one once rows change.
  const feti::DualProblem& problem() const { return *problem_; }
  /// The energy norm that is nothing beside the states before: rounding and tolerances leave as much of a state without a load.
  double negligible() const { return 1e-8 * largest_norm_; }
  /// What counts as rounding in the states before.
  const post::Rounding& rounding_before() const { return rounding_before_; }
  /// Products of the approaches before.
  int spent_before() const { return spent_before_; }
  /// Products of all load steps and of the approaches before, also of a load step that threw.
  int applications() const { return before_ + (solver_ ? solver_->applications() : 0); }

 private:
  /// In the energy norm: the estimated error of the mesh; the size of what is strained, but a thousandth of the whole at least;
  /// the whole, with what springs store: of a body that hangs on springs they may have all of it.
  struct Norms {
    double error = 0, size = 0, whole = 0;
  };
  Norms norms(std::span<const fem::Constitution> constitution, const Vector& lambda,
              const std::vector<Eigen::VectorXd>& displacement) const;
  std::unique_ptr<feti::DualProblem> make_problem(std::vector<Eigen::VectorXd> load) const;
  void make_solver();
  void update(const model::LoadState& acts, StepState& from);

  const Assembly& assembly_;
  const Context& context_;
  Approach& approach_;
  const int spent_before_;
  std::shared_ptr<const Rows> rows_;  // of the problem
  std::unique_ptr<feti::DualProblem> problem_;
  std::optional<friction::Solver> solver_;  // refers to the problem
  int before_ = 0;                          // products of the solvers and approaches before this one
  post::Rounding rounding_before_;
  double largest_force_ = 0;  // ||B'lambda||, likewise
  double largest_norm_ = 0;   // energy norm, springs included, of all states before
};

/// What there is to know of a state that solver.solve() returned last, also inside bodies where `probes` are. Throws
/// Error(no_equilibrium) if it is none. Collective.
post::Results evaluate(const Assembly& assembly, const LoadStepSolver& solver, const StepState& state, const post::Probes& probes,
                       const Context& context);

}  // namespace mortise::analysis
