#include "analysis/dual_solver.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "feti/contact_converged.hpp"
#include "feti/means.hpp"
#include "feti/no_equilibrium.hpp"
#include "friction/coulomb.hpp"

namespace mortise::analysis {

// One load step on its way.
struct DualSolver::Step {
  const feti::DualProblem& problem;
  const std::optional<qp::Solution>& before;  // of the load step before
  std::optional<qp::Patience> patience;
  std::shared_ptr<const qp::RightHandSide> right;
  std::vector<double> radii;          // of discs: those to begin with, at the end those of the last problem
  std::optional<qp::Solution> start;  // `before`, or what the algorithm knows better
  qp::Goal goal;
  const Observer& watch;
  qp::Foreknown known = {};  // of the algorithm
};

DualSolver::DualSolver(std::shared_ptr<const feti::DualSystem> system, std::vector<friction::Law> laws,
                       const friction::Options& loop, const qp::Options& solver)
    : system_(std::move(system)),
      laws_(std::move(laws)),
      loop_(loop),
      tolerance_(solver.tolerance.value),
      from_direct_(qp::solver_kind(solver.algorithm).whole_bodies),
      preconditioner_(system_->make_preconditioner()),
      product_(system_->hessian()),
      hessian_(product_, 0,
               [this](const Vector& x, const qp::RightHandSide& right, Vector& gradient) {
                 system_->gradient(product_, x, right, gradient);
               }),
      budget_(hessian_, solver.max_multiplications.value, qp::solver_kind(solver.algorithm).steady),
      omega_(friction::with_coefficients(*system_, laws_)),
      algorithm_(qp::solver_kind(solver.algorithm)
                     .make({hessian_, system_->equality(), omega_}, feti::means_of(*system_, preconditioner_.get(), budget_)))
{
  if (qp::solver_kind(solver.algorithm).exact_products && system_->rounding() > 0)
    throw std::logic_error("the products of this solver have to be exact");
}

// Of a residual, or of the error that is good enough, whose contacts must have converged as well.
qp::Goal DualSolver::goal(const feti::DualProblem& problem, const qp::Goal& accuracy) const
{
  if (tolerance_)
    return {.residual = *tolerance_,
            .contact_converged = [&problem](const Vector& x, const Vector& /*argument*/,
                                            const Vector& off) { return feti::contact_forces_known(problem, x, off); },
            .incompatibility = accuracy.incompatibility,
            .energy_norm = accuracy.energy_norm};
  qp::Goal goal = accuracy;
  goal.contact_converged = [&problem](const Vector& x, const Vector& argument, const Vector& off) {
    return feti::contact_converged(problem, x, argument, off);
  };
  return goal;
}

feti::DualSolution DualSolver::solve(const feti::DualProblem& problem, const std::optional<qp::Solution>& before,
                                     const qp::Goal& accuracy, const Observer& observer, std::optional<qp::Patience> patience,
                                     const qp::Solution* suggested)
{
  if (&problem.system() != system_.get()) throw std::logic_error("a problem of another system than the solver's");
  const int spent = hessian_.count();
  budget_.start(patience, tolerance_.value_or(qp::Goal{}.residual));
  feti::StateRecord states;
  const Observer watch = [&](int step, double change, const qp::Progress& progress) {
    std::optional<long long> changes;
    if (progress.point)
      changes = problem.communicator().sum(states.note(feti::states_at(problem, *progress.set, *progress.point)));
    budget_.note(progress, changes, change);
    if (observer) observer(step, change, progress);
  };
  Step step{problem, before, patience, problem.driven_right_hand_side(hessian_), {}, before, goal(problem, accuracy), watch};
  step.radii = problem.radii(friction::slip_bounds(problem, laws_, nullptr));
  step.known = algorithm_->begin(
      *step.right, step.radii, step.start, step.goal, [&](const qp::Progress& p) { watch(0, 1, p); }, suggested);
  auto result = friction::any_coulomb(laws_) ? solve_coulomb(step) : solve_tresca(step);
  result.gave_up = patience && !result.converged && budget_.left();
  if (!result.converged && hessian_.exhausted()) result.limit = budget_.reason();
  if (result.converged) result.limit.clear();
  result.applications = hessian_.count() - spent;
  const auto set = omega_.with_radii(step.radii);
  result.slip_bounds = problem.slip_bounds(set);
  if (!result.gave_up) tell_unresolved_nodes(step, set, states, result);
  return result;
}

// Slip bounds are given, or there are none.
feti::DualSolution DualSolver::solve_tresca(Step& step)
{
  auto found = algorithm_->solve(
      *step.right, step.radii, step.start, step.goal, [&](const qp::Progress& p) { step.watch(1, 1, p); }, &step.known);
  if (!found.feasible) feti::nothing_found(step.problem, omega_.with_radii(step.radii), found.nu, found.empty);
  feti::DualSolution result{std::move(found)};
  result.converged = result.solution.converged;
  result.preconditionings = result.solution.preconditionings;
  result.outer_iterations = result.solution.outer_iterations;
  return result;
}

// Bounds and forces together; where that does not converge the fixed point goes on from there, and last comes the slower way of
// the first. With patience other approaches come before these.
feti::DualSolution DualSolver::solve_coulomb(Step& step)
{
  const bool persistent = !step.patience;
  auto [result, radii] =
      friction::solve_coulomb({step.problem, laws_, omega_, *step.right, step.goal, loop_, step.before, step.start},
                              {*algorithm_, hessian_, budget_, &step.known},
                              {.fixed_point = persistent || from_direct_, .cautiously = persistent}, step.watch);
  step.radii = std::move(radii);
  return std::move(result);
}

// What the last residual still changes, by the preconditioner. No product.
void DualSolver::tell_unresolved_nodes(const Step& step, const qp::FeasibleSet& set, const feti::StateRecord& states,
                                       feti::DualSolution& result)
{
  const auto& problem = step.problem;
  const auto& bonded = problem.constraints().contacts.bonded;
  const bool any = std::find(bonded.begin(), bonded.end(), false) != bonded.end();
  if (!problem.communicator().any(any)) return;
  std::optional<qp::PredictedSolution> predicted;
  if (auto* preconditioner = algorithm_->preconditioner())
    predicted = qp::predict({{hessian_, system_->equality(), omega_}, *step.right, set}, result.solution, *preconditioner);
  if (predicted) result.undecided = feti::undecided(problem, set, result.solution.x, *predicted);
  if (!result.converged) result.stuck = feti::stuck(problem, states, result.solution.x, predicted ? &*predicted : nullptr);
}

}  // namespace mortise::analysis
