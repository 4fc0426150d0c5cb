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

// All changes that are to come over the next one, if each is so much of the one before; `response`: see Response.
double to_come(const std::optional<double>& response)
{
  if (!response) return 1;
  return *response < 1 ? std::min(1 / (1 - *response), SearchLimits::to_come) : SearchLimits::to_come;
}

// How exactly Tresca problems are solved: no more than their bounds are known; ever more where bounds rest beside an error that
// is too large.
class Strictness {
 public:
  Strictness(const qp::Goal& goal, const Options& options)
      : at_rest_(options.tolerance),
        asked_(goal.allowed_error ? SearchLimits::below_tolerance * options.tolerance : goal.residual)
  {
  }

  // Of the next one. Looser again would bring swings of its own; and bounds that rest but for a loose tolerance would stay where
  // they are.
  double tolerance() const
  {
    if (least_change_ <= at_rest_) return tightest();
    return std::max(tightest(), std::min(qp::limits::Every::loosest, SearchLimits::below_change * factor_ * least_change_));
  }

  // The bounds would change by so much after a problem with that tolerance. `apart`: there are several groups of bodies.
  void note(double change, double tolerance, bool apart)
  {
    idle_ = !apart || change < least_change_ ? 0 : idle_ + 1;
    if ((change <= at_rest_ && tolerance <= tightest()) || idle_ >= SearchLimits::idle_steps) {
      factor_ *= SearchLimits::stricter;
      idle_ = 0;
    }
    least_change_ = std::min(least_change_, change);
  }

 private:
  double tightest() const { return std::max(qp::limits::Every::rounding, factor_ * asked_); }

  const double at_rest_, asked_;
  double factor_ = 1, least_change_ = 1;
  int idle_ = 0;
};

}  // namespace

// Whether no contact's forces change much any more, and displacements fit together: where the error of the whole is small, that
// of a part that stores little may not be.
bool CoulombSearch::contacts_at_rest(const qp::Solution& solution) const
{
  const auto& goal = problem_.goal;
  qp::ActiveSetPreconditioner* preconditioner = means_.algorithm.preconditioner();
  if (goal.contact_converged && preconditioner) {
    const auto set = problem_.omega.with_radii(at_work_);
    const auto predicted =
        qp::predict({{means_.hessian, problem_.dual.equality(), set}, problem_.right, set}, solution, *preconditioner);
    if (predicted && !goal.contact_converged(solution.x, predicted->argument, predicted->change)) return false;
  }
  return !goal.incompatibility || goal.incompatibility(solution.x, solution.nu) <= qp::limits::Every::nearly_compatible;
}

// Whether a small residual of the solution is to be believed.
bool CoulombSearch::believable(const qp::Solution& solution) const
{
  const double rounding = qp::rounding_of_error(problem_.right.b, solution.hessian_norm);
  return qp::believable(solution.error, rounding, solution.x, solution.nu, problem_.goal);
}

// Whether the fixed point is at rest, with bounds `wanted` that the last Tresca problem asks for.
bool CoulombSearch::at_rest(Found& found, const std::vector<double>& wanted, double tolerance,
                            const std::optional<double>& response)
{
  auto& solution = found.solution;
  const auto& goal = problem_.goal;
  const bool bounds_rest = change_ <= problem_.options.tolerance;
  if (!goal.allowed_error || !std::isfinite(solution.error))
    return bounds_rest && tolerance <= goal.residual && solution.converged && believable(solution);
  solution.error += error_of_bounds(solution, wanted) * to_come(response);
  if (change_ <= Limits::obeyed && solution.error <= goal.allowed_error(solution.x, solution.nu) && qp::fits(solution, goal) &&
      balances(problem_.dual, problem_.omega, wanted, solution.x) && contacts_at_rest(solution) && judge(found))
    return true;
  // A mesh without an error of its own (a uniform stress) allows none: bounds and residual at rest are enough, too.
  return bounds_rest && solution.converged && tolerance <= Limits::below_tolerance * problem_.options.tolerance &&
         believable(solution);
}

// ||.||_F of what multipliers on the edge of their discs would move by with the bounds `wanted`. One product.
double CoulombSearch::error_of_bounds(const qp::Solution& solution, const std::vector<double>& wanted) const
{
  Vector moved(solution.x.getMap()), product(moved.getMap());
  {
    const auto x = view(std::as_const(solution.x));
    auto to = view(moved);
    const auto discs = problem_.omega.discs();
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const Eigen::Vector2d at = qp::from_centre(discs[i], x);
      if (!std::isfinite(wanted[i]) || !std::isfinite(at_work_[i]) || at.norm() < 0.99 * at_work_[i] || at.norm() == 0) continue;
      for (int k = 0; k < discs[i].size(); ++k)
        to[discs[i].index[static_cast<std::size_t>(k)]] = (wanted[i] - at_work_[i]) * at[k] / at.norm();
    }
  }
  if (moved.norm2() == 0) return 0;
  problem_.dual.equality().project(moved);
  means_.hessian.apply(moved, product);
  return std::sqrt(std::max(moved.dot(product), 0.0));
}

// Bounds that leave a feasible point: those of the forces within the cones of friction that balance the loads and are nearest to
// those of `found`. Where there are none, nothing obeys the law. In a set of given bounds they would be on the edge, so bounds
// are a little larger. `infeasible`: what the problem at work came to.
std::vector<double> CoulombSearch::admitted_radii(const qp::Solution& found, const qp::Solution& infeasible) const
{
  const qp::FeasibleSet cones = problem_.omega.with_radii(at_work_).with_cones();
  const auto& e = problem_.right.e;
  qp::Projector projector(problem_.dual.equality(), cones);
  qp::Projection nearest = projector(found.x, e, cones);
  if (!nearest.found && nearest.residual > Limits::balanced) {
    const bool proven = infeasible.empty;
    if (!proven && !nearest.empty) projector.prove_empty(e, cones, nearest);
    feti::no_equilibrium(problem_.dual, proven ? infeasible.nu : nearest.nu, feti::fall_short(nearest));
  }
  auto radii = radii_at(&nearest.point);
  for (auto& radius : radii) radius *= Limits::room;
  return radii;
}

CoulombSearch::Found CoulombSearch::fixed_point(std::optional<Found> found)
{
  if (found && found->converged) return std::move(*found);
  const auto& [dual, laws, omega, right, goal, options, before, start] = problem_;
  auto previous = radii_at(nullptr), radii = found ? radii_at(&found->solution.x) : previous;  // of the last step, of the next
  Relaxation relaxation(dual.communicator());
  Response response(dual.communicator());
  Strictness strictness(goal, options);
  int failures = 0, infeasible = 0, falls = 0;
  const auto& groups = dual.system().groups().of_body;
  const bool apart = std::any_of(groups.begin(), groups.end(), [&](int g) { return g != groups.front(); });
  means_.budget.change_algorithm();
  for (;;) {
    ++step_;
    const double tolerance = strictness.tolerance();
    at_work_ = radii;
    auto next =
        means_.algorithm.solve(right, radii, found ? std::optional(found->solution) : start, {tolerance}, watch_, means_.known);
    if (!next.feasible) {
      if (!found) feti::nothing_found(dual, omega.with_radii(radii).with_cones(), next.nu, next.empty);
      // Bounds fell ever faster until they were too small, and did so again from those that are surely enough.
      if (infeasible == 0 && relaxation.growing() >= Limits::steps_of_fall && ++falls >= Limits::most_falls)
        refuse_if_far(dual, omega, laws, found->solution.x, response.part());
      if (++failures > Limits::most_failures || step_ >= options.max_steps) {
        refuse_if_far(dual, omega, laws, found->solution.x, response.part());
        return std::move(*found);
      }
      // Bounds from inexact normal forces may fall short by as much: half way back, now and then to what surely is feasible.
      auto admitted = admitted_radii(found->solution, next);
      radii = ++infeasible % Limits::retreats != 0 ? qp::half_way_back(radii, previous) : std::move(admitted);
      continue;
    }
    infeasible = 0;
    const bool first = !found;
    count(next);
    found = Found{std::move(next)};
    auto wanted = radii_at(&found->solution.x);
    change_ = first ? 1.0 : change_of_bounds(wanted, radii, found->solution);
    response.note(radii, wanted);
    found->converged = !first && at_rest(*found, wanted, tolerance, response.part());
    if (found->converged || step_ >= options.max_steps || means_.hessian.exhausted()) return std::move(*found);
    if (!first) strictness.note(change_, tolerance, apart);
    const double part = relaxation(radii, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!std::isinf(radii[i])) wanted[i] = radii[i] + part * (wanted[i] - radii[i]);
    previous = std::exchange(radii, std::move(wanted));
  }
}

}  // namespace mortise::friction
