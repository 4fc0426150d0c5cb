#include "friction/friction.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "contact_converged.hpp"
#include "equilibrium.hpp"
#include "feti/means.hpp"
#include "friction_run.hpp"
#include "qp/error_estimate.hpp"
#include "unresolved_nodes.hpp"

namespace mortise::friction {

namespace {

bool any_coulomb(const std::vector<Law>& laws)
{
  return std::any_of(laws.begin(), laws.end(), [](const Law& law) { return law.kind == Law::Kind::coulomb; });
}

// Omega with the coefficients of the laws.
qp::FeasibleSet omega(const feti::DualProblem& problem, const std::vector<Law>& laws)
{
  auto result = problem.set();
  result.set_coefficients(coefficients(problem, laws));
  return result;
}

}  // namespace

Solver::Solver(feti::DualProblem& problem, std::vector<Law> laws, const Options& options, const qp::Options& solver)
    : problem_(problem),
      laws_(std::move(laws)),
      options_(options),
      tolerance_(solver.tolerance.value),
      from_direct_(solver.algorithm == "direct"),
      hessian_(problem.hessian(), 0),
      budget_(hessian_, solver.max_multiplications.value, qp::solver_kind(solver.algorithm).steady),
      omega_(omega(problem, laws_)),
      algorithm_(qp::solver_kind(solver.algorithm).make({hessian_, problem.equality(), omega_}, feti::means_of(problem, budget_)))
{
}

Solver::~Solver() = default;

// The radii of discs by the law, with the forces of these multipliers or before any are known.
std::vector<double> Solver::radii_at(const Vector* lambda) const
{
  return problem_.radii(friction::slip_bounds(problem_, laws_, lambda));
}

// ||wanted - now|| / ||wanted|| of slip bounds at a solution, but for what rounding makes of no force at all: of multipliers of
// the size ||b|| / ||A||.
double Solver::change_of_bounds(const std::vector<double>& wanted, const std::vector<double>& now, const qp::Solution& at,
                                const Run& run) const
{
  constexpr double rounding = 1e-10;
  const double least = at.hessian_norm > 0 ? rounding * run.right->b.norm2() / at.hessian_norm : 0;
  return relative_change(problem_, wanted, now, least);
}

// Bounds and forces together, if the algorithm can. Where that does not converge, the fixed point goes on from there.
void Solver::follow_law(Run& run)
{
  const qp::SlipLaw law{[this](const Vector* x) { return radii_at(x); }};
  run.step = 1;
  auto found = algorithm_->solve(*run.right, law, run.solution, run.goal, run.watch);
  if (found && found->slides) {
    refuse_if_sliding(problem_, omega_, laws_, found->x);
    found = algorithm_->solve(*run.right, law, run.solution, run.goal, run.watch);
  }
  if (!found) {
    run.step = 0;
    return;
  }
  run.count(*found);
  run.at_work = found->radii;
  if (!found->feasible) return;
  run.radii = radii_at(&found->x);
  run.change = change_of_bounds(run.radii, run.at_work, *found, run);
  run.converged = obeys_law(*found, run.radii, run.change, run);
  run.solution = std::move(found);
  run.solved = true;
}

// Of bounds and forces that were found together. Where the error decides, what the bounds would still change counts in it.
bool Solver::obeys_law(const qp::Solution& found, const std::vector<double>& bounds, double change, const Run& run) const
{
  return found.converged && (run.goal.allowed_error || change <= options_.tolerance) &&
         balances(problem_, omega_, bounds, found.x);
}

// Once more together from the beginning, where neither that nor the fixed point converges, by steps that may be shortened.
void Solver::follow_cautiously(const qp::Solution* start, Run& run)
{
  if (hessian_.exhausted()) run.limit = budget_.reason();
  if (run.converged || run.patience || !budget_.left()) return;
  budget_.change_algorithm();
  const qp::SlipLaw law{[this](const Vector* x) { return radii_at(x); }, true};
  std::optional<qp::Solution> from;
  if (start) from = *start;
  auto found = algorithm_->solve(*run.right, law, from, run.goal, run.watch);
  if (!found) return;
  run.count(*found);
  if (!found->feasible) return;
  auto bounds = radii_at(&found->x);
  const double change = change_of_bounds(bounds, found->radii, *found, run);
  if (!obeys_law(*found, bounds, change, run)) return;
  run.at_work = found->radii;
  run.radii = std::move(bounds);
  run.change = change;
  run.solution = std::move(found);
  run.solved = run.converged = true;
}

// Everything that a load step needs before its first solve.
Solver::Run Solver::begin(const qp::Solution* start, const Accuracy& accuracy, std::optional<qp::Patience> patience)
{
  budget_.start(patience, tolerance_.value_or(qp::Goal{}.residual));
  Run run;
  run.right = problem_.driven_right_hand_side(hessian_);
  run.patience = patience;
  if (tolerance_) {
    run.goal.residual = *tolerance_;
  } else {
    run.goal.allowed_error = accuracy.allowed_error;
    run.goal.expected_allowed_error = accuracy.expected_allowed_error;
    run.goal.contact_converged = [this](const Vector& x, const Vector& argument, const Vector& off) {
      return contact_converged(problem_, x, argument, off);
    };
    run.goal.incompatibility = accuracy.incompatibility;
    run.goal.negligible = accuracy.negligible;
  }
  run.goal.energy_norm = accuracy.energy_norm;
  if (start) run.solution = *start;
  run.radii = run.previous_radii = run.at_work = radii_at(nullptr);
  return run;
}

Result Solver::solve(const qp::Solution* start, const Accuracy& accuracy, const Observer& observer,
                     std::optional<qp::Patience> patience)
{
  const bool coulomb = any_coulomb(laws_);
  const int before = hessian_.count();
  Run run = begin(start, accuracy, patience);
  run.watch = [&](const qp::Progress& progress) {
    note(run, progress);
    if (observer) observer(run.step, run.change, progress);
  };
  algorithm_->begin(*run.right, run.radii, run.solution, run.goal, run.watch);
  if (coulomb) {
    follow_law(run);
    if (!run.solved || !patience || from_direct_) fixed_point(run);  // a few products each, from what A^-1 leads on from
    follow_cautiously(start, run);
    const bool spent = !run.limit.empty() || hessian_.exhausted();
    if (run.solved && (run.converged || !spent))
      judge_by_law(problem_, omega_.with_radii(run.at_work), laws_, hessian_, *run.solution);
  } else {
    run.step = 1;
    if (!solve_tresca(run.goal, run)) nothing_found(problem_, omega_.with_radii(run.at_work), run.escape, run.proven);
    run.converged = true;
    run.change = 0;
  }
  Result result{std::move(*run.solution), problem_.slip_bounds(omega_.with_radii(run.at_work))};
  result.steps = run.step;
  result.change = run.change;
  result.converged = run.converged && result.solution.converged;
  result.gave_up = patience && !result.converged && budget_.left();
  if (!result.converged && hessian_.exhausted())
    result.limit = budget_.reason();
  else if (!result.converged && !run.limit.empty())
    result.limit = run.limit;
  else if (!result.converged && coulomb && run.step >= options_.max_steps)
    result.limit = "friction_loop.max_steps";
  result.applications = hessian_.count() - before;
  result.preconditionings = run.preconditionings;
  result.outer_iterations = run.outer;
  if (!result.gave_up) report_unresolved_nodes(run, result);
  return result;
}

void Solver::note(Run& run, const qp::Progress& progress)
{
  std::optional<long long> changes;
  if (progress.point) changes = problem_.communicator().sum(run.states.note(states_at(problem_, *progress.set, *progress.point)));
  budget_.note(progress, changes, run.change);
}

// What the last residual still changes, by the preconditioner. No product.
void Solver::report_unresolved_nodes(const Run& run, Result& result)
{
  const auto& bonded = problem_.constraints().contacts.bonded;
  const bool any = std::find(bonded.begin(), bonded.end(), false) != bonded.end();
  if (!problem_.communicator().any(any)) return;
  qp::ActiveSetPreconditioner* preconditioner = algorithm_->preconditioner();
  const auto set = omega_.with_radii(run.at_work);
  const auto predicted = preconditioner ? predict(problem_, set, result.solution, *preconditioner) : std::nullopt;
  if (predicted) result.undecided = undecided(problem_, set, result.solution.x, *predicted);
  if (!result.converged) result.stuck = stuck(problem_, run.states, result.solution.x, predicted ? &*predicted : nullptr);
}

}  // namespace mortise::friction
