#include "friction/friction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "contact_converged.hpp"
#include "equilibrium.hpp"
#include "feti/means.hpp"
#include "qp/error_estimate.hpp"
#include "relaxation.hpp"
#include "state_record.hpp"
#include "unresolved_nodes.hpp"

namespace mortise::friction {

namespace {

constexpr double worth_a_look = 0.05;  // change of the slip bounds at which the allowed error is asked for

bool any_coulomb(const std::vector<Law>& laws)
{
  return std::any_of(laws.begin(), laws.end(), [](const Law& law) { return law.kind == Law::Kind::coulomb; });
}

// Radii that discs have.
std::vector<double> radii_of(const qp::FeasibleSet& set)
{
  std::vector<double> result;
  for (const auto& disc : set.discs()) result.push_back(disc.radius);
  return result;
}

}  // namespace

// One load step on its way.
struct Solver::Run {
  qp::Goal goal;
  qp::Observer watch;
  std::optional<qp::Patience> patience;
  StateRecord states;  // of contact nodes
  std::vector<double> radii, previous_radii;  // of discs, see DualProblem::radii()
  std::optional<qp::Solution> solution;  // at first that of the load step before
  bool solved = false;                   // `solution` is of this load step
  Eigen::VectorXd escape;                // nu of the last Tresca problem that was infeasible,
  bool proven = false;                   // and whether it proves that
  double change = 1, least_change = 1;
  bool any_answer = false;               // of a Tresca problem,
  std::vector<double> answered, answer;  // its last radii, and those that its solution asks for; maybe none on this rank
  double response = 1;                   // how much of a change of bounds the normal forces answer with; 1: unknown
  int step = 0, outer = 0, preconditionings = 0;
  bool converged = false;
  std::string limit;  // of products, that ended it

  void count(const qp::Solution& found)
  {
    outer += found.outer_iterations;
    preconditionings += found.preconditionings;
  }
};

Solver::Solver(feti::DualProblem& problem, std::vector<Law> laws, const Options& options, const qp::Options& solver)
    : problem_(problem),
      laws_(std::move(laws)),
      options_(options),
      tolerance_(solver.tolerance.value),
      from_direct_(solver.algorithm == "direct"),
      hessian_(problem.hessian(), 0),
      budget_(hessian_, solver.max_multiplications.value, qp::solver_kind(solver.algorithm).steady),
      driven_(problem.linear().getMap()),
      set_(problem.set()),
      programme_{hessian_, problem.linear(), problem.equality(), set_, problem.balancing_multipliers() ? &driven_ : nullptr}
{
  set_.set_coefficients(coefficients(problem, laws_));
  algorithm_ = qp::solver_kind(solver.algorithm).make(programme_, feti::means_of(problem, budget_));
}

Solver::~Solver() = default;

// The radii of discs by the law, with the forces of these multipliers or before any are known.
std::vector<double> Solver::radii_at(const Vector* lambda) const
{
  return problem_.radii(friction::slip_bounds(problem_, laws_, lambda));
}

// ||wanted - now|| / ||wanted|| of slip bounds at a solution, but for what rounding makes of no force at all: of multipliers of
// the size ||b|| / ||A||.
double Solver::change_of_bounds(const std::vector<double>& wanted, const std::vector<double>& now, const qp::Solution& at) const
{
  constexpr double rounding = 1e-10;
  const double least = at.hessian_norm > 0 ? rounding * programme_.linear.norm2() / at.hessian_norm : 0;
  return relative_change(problem_, wanted, now, least);
}

// Bounds and forces together, if the algorithm can. Where that does not converge, the fixed point goes on from there.
void Solver::follow_law(Run& run)
{
  const qp::SlipLaw law{set_, [this](const Vector* x) { return radii_at(x); }};
  run.step = 1;
  auto found = algorithm_->solve(law, run.solution, run.goal, run.watch);
  if (found && found->slides) {
    refuse_if_sliding(problem_, set_, laws_, found->x);
    found = algorithm_->solve(law, run.solution, run.goal, run.watch);
  }
  if (!found) {
    run.step = 0;
    return;
  }
  run.count(*found);
  if (!found->feasible) return;
  run.radii = radii_at(&found->x);
  run.change = change_of_bounds(run.radii, radii_of(set_), *found);
  run.converged = obeys_law(*found, run.radii, run.change, run);
  run.solution = std::move(found);
  run.solved = true;
}

// Of bounds and forces that were found together. Where the error decides, what the bounds would still change counts in it.
bool Solver::obeys_law(const qp::Solution& found, const std::vector<double>& bounds, double change, const Run& run) const
{
  return found.converged && (run.goal.allowed_error || change <= options_.tolerance) && balances(problem_, set_, bounds, found.x);
}

// Once more together from the beginning, where neither that nor the fixed point converges, by steps that may be shortened.
void Solver::follow_cautiously(const qp::Solution* start, Run& run)
{
  if (hessian_.exhausted()) run.limit = budget_.reason();
  if (run.converged || run.patience || !budget_.left()) return;
  budget_.change_algorithm();
  const auto before = radii_of(set_);
  const qp::SlipLaw law{set_, [this](const Vector* x) { return radii_at(x); }, true};
  std::optional<qp::Solution> from;
  if (start) from = *start;
  auto found = algorithm_->solve(law, from, run.goal, run.watch);
  if (!found) return;
  run.count(*found);
  if (found->feasible) {
    auto bounds = radii_at(&found->x);
    const double change = change_of_bounds(bounds, radii_of(set_), *found);
    if (obeys_law(*found, bounds, change, run)) {
      run.radii = std::move(bounds);
      run.change = change;
      run.solution = std::move(found);
      run.solved = run.converged = true;
      return;
    }
  }
  set_.set_radii(before);
}

// One Tresca problem; false if it is infeasible.
bool Solver::solve_tresca(const qp::Goal& goal, Run& run)
{
  set_.set_radii(run.radii);
  auto next = algorithm_->solve(run.solution, goal, run.watch);
  if (!next.feasible) {
    run.escape = next.nu;
    run.proven = next.empty;
    return false;
  }
  run.count(next);
  run.solution = std::move(next);
  return true;
}

// Whether no contact's forces change much any more, and displacements fit together: where the error of the whole is small, that
// of a part that stores little may not be.
bool Solver::contacts_at_rest(const Run& run)
{
  const auto& solution = *run.solution;
  const auto& goal = run.goal;
  qp::ActiveSetPreconditioner* preconditioner = algorithm_->preconditioner();
  if (goal.contact_converged && preconditioner) {
    const auto predicted = predict(problem_, set_, solution, *preconditioner);
    if (predicted && !goal.contact_converged(solution.x, predicted->argument, predicted->change)) return false;
  }
  return !goal.incompatibility || goal.incompatibility(solution.x, solution.nu) <= qp::Goal::nearly_compatible;
}

// Whether the fixed point is at rest, with bounds `wanted` that the last Tresca problem asks for.
bool Solver::at_rest(const std::vector<double>& wanted, double tolerance, Run& run)
{
  auto& solution = *run.solution;
  if (!run.goal.allowed_error || !std::isfinite(solution.error))
    return run.change <= options_.tolerance && tolerance <= run.goal.residual && solution.converged &&
           qp::believable(solution.error, qp::rounding_of_error(programme_, solution.hessian_norm), solution.x, solution.nu,
                          run.goal);
  solution.error += error_of_bounds(wanted, run);
  if (run.change <= worth_a_look && solution.error <= run.goal.allowed_error(solution.x, solution.nu) &&
      qp::fits(solution, run.goal) && balances(problem_, set_, wanted, solution.x) && contacts_at_rest(run))
    return true;
  // A mesh without an error of its own (a uniform stress) allows none: bounds and residual at rest are enough, too.
  return run.change <= options_.tolerance && solution.converged && tolerance <= 1e-1 * options_.tolerance &&
         qp::believable(solution.error, qp::rounding_of_error(programme_, solution.hessian_norm), solution.x, solution.nu,
                        run.goal);
}

// Of the last step that changes the bounds by more than rounding. Collective.
void Solver::note_response(const std::vector<double>& wanted, Run& run) const
{
  constexpr double step = 1e-3;
  if (run.any_answer) {
    std::array<double, 3> squares{0, 0, 0};  // of the changes of bounds and answers, of the answers
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!std::isfinite(run.radii[i]) || !std::isfinite(run.answered[i])) continue;
      squares[0] += std::pow(run.radii[i] - run.answered[i], 2);
      squares[1] += std::pow(wanted[i] - run.answer[i], 2);
      squares[2] += wanted[i] * wanted[i];
    }
    problem_.communicator().sum_in_place(squares);
    if (squares[0] > step * step * squares[2]) run.response = std::sqrt(squares[1] / squares[0]);
  }
  run.any_answer = true;
  run.answered = run.radii;
  run.answer = wanted;
}

// ||.||_F of what multipliers on the edge of their discs would move by with the bounds `wanted`. One product.
double Solver::error_of_bounds(const std::vector<double>& wanted, const Run& run)
{
  Vector moved(problem_.linear().getMap()), product(moved.getMap());
  {
    const auto x = view(std::as_const(run.solution->x));
    auto to = view(moved);
    const auto discs = set_.discs();
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const Eigen::Vector2d at = qp::from_centre(discs[i], x);
      if (!std::isfinite(wanted[i]) || !std::isfinite(run.radii[i]) || at.norm() < 0.99 * run.radii[i] || at.norm() == 0)
        continue;
      for (int k = 0; k < discs[i].size(); ++k)
        to[discs[i].index[static_cast<std::size_t>(k)]] = (wanted[i] - run.radii[i]) * at[k] / at.norm();
    }
  }
  if (moved.norm2() == 0) return 0;
  problem_.equality().project(moved);
  hessian_.apply(moved, product);
  return std::sqrt(std::max(moved.dot(product), 0.0));
}

// Bounds that leave a feasible point: those of the forces within the cones of friction that balance the loads and are nearest to
// the present ones. Where there are none, nothing obeys the law. In a set of given bounds they would be on the edge, so bounds
// are a little larger.
void Solver::admit(Run& run)
{
  constexpr double room = 1 + 1e-6;
  constexpr double balanced = 1e-6;  // of all forces: what a search that does not converge may leave
  const qp::FeasibleSet cones = set_.with_cones();
  const qp::Projection nearest = qp::project(run.solution->x, problem_.equality(), cones);
  if (!nearest.found && nearest.residual > balanced)
    no_equilibrium(problem_, run.proven ? run.escape : nearest.nu, fall_short(nearest));
  run.radii = radii_at(&nearest.point);
  for (auto& bound : run.radii) bound *= room;
}

// Tresca problems until their bounds are at rest.
void Solver::fixed_point(Run& run)
{
  constexpr int retreats = 4;  // in a row
  constexpr int most_failures = 15;
  constexpr int steps_of_fall = 2, most_falls = 2;
  constexpr int idle_steps = 3;  // without a smaller change, which is then what solutions leave of the light groups of bodies
  Relaxation relaxation(problem_.communicator());
  int infeasible = 0, failures = 0, falls = 0, idle = 0;
  double strictness = 1;
  const auto& groups = problem_.groups().of_body;
  const bool apart = std::any_of(groups.begin(), groups.end(), [&](int g) { return g != groups.front(); });
  if (!run.converged) budget_.change_algorithm();
  while (!run.converged) {
    ++run.step;
    // Looser again would bring swings of its own; and bounds that rest but for a loose tolerance would stay where they are.
    const double tightest =
        std::max(qp::tolerances::rounding, strictness * (run.goal.allowed_error ? 0.1 * options_.tolerance : run.goal.residual));
    const double tolerance = run.least_change <= options_.tolerance
                                 ? tightest
                                 : std::max(tightest, std::min(qp::tolerances::loosest, 0.1 * strictness * run.least_change));
    const bool first = !run.solved;
    if (!solve_tresca({tolerance}, run)) {
      if (!run.solved) nothing_found(problem_, set_.with_cones(), run.escape, run.proven);
      // Bounds fell ever faster until they were too small, and did so again from those that are surely enough.
      if (infeasible == 0 && relaxation.growing() >= steps_of_fall && ++falls >= most_falls)
        refuse_if_far(problem_, set_, laws_, run.solution->x, run.response);
      set_.set_radii(run.radii);
      if (++failures > most_failures || run.step >= options_.max_steps) {
        refuse_if_far(problem_, set_, laws_, run.solution->x, run.response);
        return;
      }
      // Bounds from inexact normal forces may fall short by as much: half way back, now and then to what surely is feasible.
      auto half_way = qp::half_way_back(run.radii, run.previous_radii);
      admit(run);
      if (++infeasible % retreats != 0) run.radii = std::move(half_way);
      continue;
    }
    run.solved = true;
    infeasible = 0;
    auto wanted = radii_at(&run.solution->x);
    run.change = first ? 1.0 : change_of_bounds(wanted, run.radii, *run.solution);
    note_response(wanted, run);
    run.converged = !first && at_rest(wanted, tolerance, run);
    idle = first || !apart || run.change < run.least_change ? 0 : idle + 1;
    // Bounds at rest beside an error that is too large.
    if (!run.converged && ((run.change <= options_.tolerance && tolerance <= tightest) || idle >= idle_steps)) {
      strictness *= 0.1;
      idle = 0;
    }
    if (run.converged || run.step >= options_.max_steps || hessian_.exhausted()) return;
    run.least_change = first ? 1.0 : std::min(run.least_change, run.change);
    const double part = relaxation(run.radii, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!std::isinf(run.radii[i])) wanted[i] = run.radii[i] + part * (wanted[i] - run.radii[i]);
    run.previous_radii = std::exchange(run.radii, std::move(wanted));
  }
}

// Everything that a load step needs before its first solve.
Solver::Run Solver::begin(const qp::Solution* start, const Accuracy& accuracy, std::optional<qp::Patience> patience)
{
  budget_.start(patience, tolerance_.value_or(qp::Goal{}.residual));
  if (problem_.balancing_multipliers()) hessian_.apply(*problem_.balancing_multipliers(), driven_);
  Run run;
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
  run.radii = run.previous_radii = radii_at(nullptr);
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
  set_.set_radii(run.radii);
  algorithm_->begin(run.solution, run.goal, run.watch);
  if (coulomb) {
    follow_law(run);
    if (!run.solved || !patience || from_direct_) fixed_point(run);  // a few products each, from what A^-1 leads on from
    follow_cautiously(start, run);
    const bool spent = !run.limit.empty() || hessian_.exhausted();
    if (run.solved && (run.converged || !spent)) judge_by_law(problem_, set_, laws_, hessian_, *run.solution);
  } else {
    run.step = 1;
    if (!solve_tresca(run.goal, run)) nothing_found(problem_, set_, run.escape, run.proven);
    run.converged = true;
    run.change = 0;
  }
  Result result{std::move(*run.solution), slip_bounds()};
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
  if (progress.point) changes = problem_.communicator().sum(run.states.note(states_at(problem_, set_, *progress.point)));
  budget_.note(progress, changes, run.change);
}

// What the last residual still changes, by the preconditioner. No product.
void Solver::report_unresolved_nodes(const Run& run, Result& result)
{
  const auto& bonded = problem_.constraints().contacts.bonded;
  const bool any = std::find(bonded.begin(), bonded.end(), false) != bonded.end();
  if (!problem_.communicator().any(any)) return;
  qp::ActiveSetPreconditioner* preconditioner = algorithm_->preconditioner();
  const auto predicted = preconditioner ? predict(problem_, set_, result.solution, *preconditioner) : std::nullopt;
  if (predicted) result.undecided = undecided(problem_, set_, result.solution.x, *predicted);
  if (!result.converged) result.stuck = stuck(problem_, run.states, result.solution.x, predicted ? &*predicted : nullptr);
}

}  // namespace mortise::friction
