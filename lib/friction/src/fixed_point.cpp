// Coulomb's law as a fixed point over Tresca problems, and when that is at rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coulomb_search.hpp"
#include "equilibrium.hpp"
#include "qp/error_estimate.hpp"
#include "qp/predicted_solution.hpp"
#include "relaxation.hpp"

namespace mortise::friction {

namespace {

// All changes that are to come over the next one, if each is so much of the one before; `response`: see CoulombSearch.
double to_come(const std::optional<double>& response)
{
  if (!response) return 1;
  return *response < 1 ? std::min(1 / (1 - *response), SearchLimits::to_come) : SearchLimits::to_come;
}

}  // namespace

// One Tresca problem; false if it is infeasible.
bool CoulombSearch::solve_tresca(const qp::Goal& goal)
{
  at_work_ = radii_;
  auto next = means_.algorithm.solve(problem_.right, radii_, solution_, goal, watch_, means_.known);
  if (!next.feasible) {
    escape_ = next.nu;
    proven_ = next.empty;
    return false;
  }
  count(next);
  solution_ = std::move(next);
  judged_ = false;
  return true;
}

// Whether no contact's forces change much any more, and displacements fit together: where the error of the whole is small, that
// of a part that stores little may not be.
bool CoulombSearch::contacts_at_rest()
{
  const auto& goal = problem_.goal;
  qp::ActiveSetPreconditioner* preconditioner = means_.algorithm.preconditioner();
  if (goal.contact_converged && preconditioner) {
    const auto set = problem_.omega.with_radii(at_work_);
    const auto predicted =
        qp::predict({{means_.hessian, problem_.dual.equality(), set}, problem_.right, set}, *solution_, *preconditioner);
    if (predicted && !goal.contact_converged(solution_->x, predicted->argument, predicted->change)) return false;
  }
  return !goal.incompatibility || goal.incompatibility(solution_->x, solution_->nu) <= qp::limits::Every::nearly_compatible;
}

// Whether a small residual of the solution is to be believed.
bool CoulombSearch::believable() const
{
  const double rounding = qp::rounding_of_error(problem_.right.b, solution_->hessian_norm);
  return qp::believable(solution_->error, rounding, solution_->x, solution_->nu, problem_.goal);
}

// Whether the fixed point is at rest, with bounds `wanted` that the last Tresca problem asks for.
bool CoulombSearch::at_rest(const std::vector<double>& wanted, double tolerance)
{
  auto& solution = *solution_;
  const auto& goal = problem_.goal;
  const bool bounds_rest = change_ <= problem_.options.tolerance;
  if (!goal.allowed_error || !std::isfinite(solution.error))
    return bounds_rest && tolerance <= goal.residual && solution.converged && believable();
  solution.error += error_of_bounds(wanted) * to_come(response_);
  if (change_ <= Limits::worth_a_look && solution.error <= goal.allowed_error(solution.x, solution.nu) &&
      qp::fits(solution, goal) && balances(problem_.dual, problem_.omega, wanted, solution.x) && contacts_at_rest() &&
      judge(solution))
    return true;
  // A mesh without an error of its own (a uniform stress) allows none: bounds and residual at rest are enough, too.
  return bounds_rest && solution.converged && tolerance <= Limits::below_tolerance * problem_.options.tolerance && believable();
}

// Of the last step that changes the bounds by more than rounding. Collective.
void CoulombSearch::note_response(const std::vector<double>& wanted)
{
  if (any_answer_) {
    std::array<double, 3> squares{0, 0, 0};  // of the changes of bounds and answers, of the answers
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!std::isfinite(radii_[i]) || !std::isfinite(answered_[i])) continue;
      squares[0] += std::pow(radii_[i] - answered_[i], 2);
      squares[1] += std::pow(wanted[i] - answer_[i], 2);
      squares[2] += wanted[i] * wanted[i];
    }
    problem_.dual.communicator().sum_in_place(squares);
    if (squares[0] > Limits::step * Limits::step * squares[2]) response_ = std::sqrt(squares[1] / squares[0]);
  }
  any_answer_ = true;
  answered_ = radii_;
  answer_ = wanted;
}

// ||.||_F of what multipliers on the edge of their discs would move by with the bounds `wanted`. One product.
double CoulombSearch::error_of_bounds(const std::vector<double>& wanted)
{
  Vector moved(solution_->x.getMap()), product(moved.getMap());
  {
    const auto x = view(std::as_const(solution_->x));
    auto to = view(moved);
    const auto discs = problem_.omega.discs();
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const Eigen::Vector2d at = qp::from_centre(discs[i], x);
      if (!std::isfinite(wanted[i]) || !std::isfinite(radii_[i]) || at.norm() < 0.99 * radii_[i] || at.norm() == 0) continue;
      for (int k = 0; k < discs[i].size(); ++k)
        to[discs[i].index[static_cast<std::size_t>(k)]] = (wanted[i] - radii_[i]) * at[k] / at.norm();
    }
  }
  if (moved.norm2() == 0) return 0;
  problem_.dual.equality().project(moved);
  means_.hessian.apply(moved, product);
  return std::sqrt(std::max(moved.dot(product), 0.0));
}

// Bounds that leave a feasible point: those of the forces within the cones of friction that balance the loads and are nearest to
// the present ones. Where there are none, nothing obeys the law. In a set of given bounds they would be on the edge, so bounds
// are a little larger.
void CoulombSearch::admit()
{
  const qp::FeasibleSet cones = problem_.omega.with_radii(at_work_).with_cones();
  const auto& e = problem_.right.e;
  qp::Projector projector(problem_.dual.equality(), cones);
  qp::Projection nearest = projector(solution_->x, e, cones);
  if (!nearest.found && nearest.residual > Limits::balanced) {
    if (!proven_ && !nearest.empty) projector.prove_empty(e, cones, nearest);
    feti::no_equilibrium(problem_.dual, proven_ ? escape_ : nearest.nu, feti::fall_short(nearest));
  }
  radii_ = radii_at(&nearest.point);
  for (auto& radius : radii_) radius *= Limits::room;
}

// Bounds from inexact normal forces may fall short by as much: half way back, now and then to what surely is feasible.
void CoulombSearch::step_back()
{
  auto half_way = qp::half_way_back(radii_, previous_radii_);
  admit();
  if (++infeasible_ % Limits::retreats != 0) radii_ = std::move(half_way);
}

void CoulombSearch::fixed_point()
{
  const auto& [dual, laws, omega, right, goal, options, before, begin] = problem_;
  Relaxation relaxation(dual.communicator());
  int failures = 0, falls = 0, idle = 0;
  double strictness = 1, least_change = 1;
  const auto& groups = dual.system().groups().of_body;
  const bool apart = std::any_of(groups.begin(), groups.end(), [&](int g) { return g != groups.front(); });
  if (!converged_) means_.budget.change_algorithm();
  while (!converged_) {
    ++step_;
    // Looser again would bring swings of its own; and bounds that rest but for a loose tolerance would stay where they are.
    const double tightest =
        std::max(qp::limits::Every::rounding,
                 strictness * (goal.allowed_error ? Limits::below_tolerance * options.tolerance : goal.residual));
    const double tolerance =
        least_change <= options.tolerance
            ? tightest
            : std::max(tightest, std::min(qp::limits::Every::loosest, Limits::below_change * strictness * least_change));
    const bool first = !solved_;
    if (!solve_tresca({tolerance})) {
      if (!solved_) feti::nothing_found(dual, omega.with_radii(at_work_).with_cones(), escape_, proven_);
      // Bounds fell ever faster until they were too small, and did so again from those that are surely enough.
      if (infeasible_ == 0 && relaxation.growing() >= Limits::steps_of_fall && ++falls >= Limits::most_falls)
        refuse_if_far(dual, omega, laws, solution_->x, response_);
      if (++failures > Limits::most_failures || step_ >= options.max_steps) {
        refuse_if_far(dual, omega, laws, solution_->x, response_);
        return;
      }
      step_back();
      continue;
    }
    solved_ = true;
    infeasible_ = 0;
    auto wanted = radii_at(&solution_->x);
    change_ = first ? 1.0 : change_of_bounds(wanted, radii_, *solution_);
    note_response(wanted);
    converged_ = !first && at_rest(wanted, tolerance);
    idle = first || !apart || change_ < least_change ? 0 : idle + 1;
    // Bounds at rest beside an error that is too large.
    if (!converged_ && ((change_ <= options.tolerance && tolerance <= tightest) || idle >= Limits::idle_steps)) {
      strictness *= Limits::stricter;
      idle = 0;
    }
    if (converged_ || step_ >= options.max_steps || means_.hessian.exhausted()) return;
    least_change = first ? 1.0 : std::min(least_change, change_);
    const double part = relaxation(radii_, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!std::isinf(radii_[i])) wanted[i] = radii_[i] + part * (wanted[i] - radii_[i]);
    previous_radii_ = std::exchange(radii_, std::move(wanted));
  }
}

}  // namespace mortise::friction
