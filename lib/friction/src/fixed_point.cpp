// Coulomb's law as a fixed point over Tresca problems, and when that is at rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "contact_converged.hpp"
#include "equilibrium.hpp"
#include "friction_run.hpp"
#include "qp/error_estimate.hpp"
#include "relaxation.hpp"
#include "unresolved_nodes.hpp"

namespace mortise::friction {

namespace {

constexpr double worth_a_look = 0.05;  // change of the slip bounds at which the allowed error is asked for

}  // namespace

// One Tresca problem; false if it is infeasible.
bool Solver::solve_tresca(const qp::Goal& goal, Run& run)
{
  run.at_work = run.radii;
  auto next = algorithm_->solve(*run.right, run.radii, run.solution, goal, run.watch);
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
    const auto predicted = predict(problem_, omega_.with_radii(run.at_work), solution, *preconditioner);
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
           qp::believable(solution.error, qp::rounding_of_error(run.right->b, solution.hessian_norm), solution.x, solution.nu,
                          run.goal);
  solution.error += error_of_bounds(wanted, run);
  if (run.change <= worth_a_look && solution.error <= run.goal.allowed_error(solution.x, solution.nu) &&
      qp::fits(solution, run.goal) && balances(problem_, omega_, wanted, solution.x) && contacts_at_rest(run))
    return true;
  // A mesh without an error of its own (a uniform stress) allows none: bounds and residual at rest are enough, too.
  return run.change <= options_.tolerance && solution.converged && tolerance <= 1e-1 * options_.tolerance &&
         qp::believable(solution.error, qp::rounding_of_error(run.right->b, solution.hessian_norm), solution.x, solution.nu,
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
  Vector moved(run.solution->x.getMap()), product(moved.getMap());
  {
    const auto x = view(std::as_const(run.solution->x));
    auto to = view(moved);
    const auto discs = omega_.discs();
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
  const qp::FeasibleSet cones = omega_.with_radii(run.at_work).with_cones();
  qp::Projector projector(problem_.equality(), cones);
  qp::Projection nearest = projector(run.solution->x, run.right->e, cones);
  if (!nearest.found && nearest.residual > balanced) {
    if (!run.proven && !nearest.empty) projector.prove_empty(run.right->e, cones, nearest);
    no_equilibrium(problem_, run.proven ? run.escape : nearest.nu, fall_short(nearest));
  }
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
      if (!run.solved) nothing_found(problem_, omega_.with_radii(run.at_work).with_cones(), run.escape, run.proven);
      // Bounds fell ever faster until they were too small, and did so again from those that are surely enough.
      if (infeasible == 0 && relaxation.growing() >= steps_of_fall && ++falls >= most_falls)
        refuse_if_far(problem_, omega_, laws_, run.solution->x, run.response);
      if (++failures > most_failures || run.step >= options_.max_steps) {
        refuse_if_far(problem_, omega_, laws_, run.solution->x, run.response);
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
    run.change = first ? 1.0 : change_of_bounds(wanted, run.radii, *run.solution, run);
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

}  // namespace mortise::friction
