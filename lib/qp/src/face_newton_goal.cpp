// When face Newton ends: whether a point is what was asked for, and when there is no hope of one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "face_newton_run.hpp"
#include "qp/error_estimate.hpp"
#include "rounding.hpp"

namespace mortise::qp {

// What residuals are relative to at least: the motions G'nu, which gaps are left by, have rounding. What moves far is not always
// asked for by b: the body on soft springs is not.
double FaceNewton::rounding_of_motions(const Run& run, const Projection& natural) const
{
  Vector motions(natural.argument, Teuchos::Copy);  // z - g / ||P A P|| - G'nu
  motions.update(-1, run.state.z, 1 / norm_, run.state.g, 1);
  return rounding_over(run.goal.allowed_error ? limits::Every::finest : run.goal.residual) * motions.norm2() * norm_;
}

// The bound of the error at z. It costs as much as some products, so it is found where somebody asks for it alone: not as long as
// a residual that is to come down to a number does so.
void FaceNewton::find_error(Run& run, const Projection& natural)
{
  run.result.error = error_bound(run.problem, run.state.z, natural, norm_, preconditioner_) *
                     (run.residual > 0 ? run.worst() / run.residual : 1.0);
  preconditionings_ += preconditioner_ ? 1 : 0;
}

// Whether the primal solution at z fulfils its constraints, as far as the goal asks for that and rounding lets it.
bool FaceNewton::is_compatible(const Run& run) const
{
  const auto& goal = run.goal;
  if (!goal.incompatibility || run.worst() <= limits::Every::rounding * run.size) return true;
  if (run.result.error <= rounding_of_error(run.problem.right.b, norm_)) return true;
  // From a direct solution figures are cheap to come by: a step of A^-1 each.
  const double enough = run.since_best > 0 ? limits::Every::nearly_compatible
                        : goal.exact > 0   ? limits::Every::exactly_compatible
                                           : limits::Every::compatible;
  return goal.incompatibility(run.state.z, run.result.nu) <= enough;
}

// Whether radii that follow the solution are at rest: an error that is small beside the mesh's may leave a joint beyond its
// friction.
bool FaceNewton::radii_at_rest(const Run& run) const
{
  if (!run.followed) return true;
  double square = 0;
  for (const auto& disc : run.problem.set.discs())
    if (std::isfinite(disc.radius)) square += disc.radius * disc.radius;
  const double change = run.mismatch * step_length / norm_;
  return change <= Limits::radii_at_rest * std::sqrt(programme_.equality.communicator().sum(square));
}

// Whether the residual or the error at z is what the goal asks for.
bool FaceNewton::is_solved(Run& run, const Projection& natural)
{
  const auto& goal = run.goal;
  const auto& z = run.state.z;
  const auto& result = run.result;
  const double worst = run.worst();
  const double to_come = run.contact.change_to_come(z, result.error);
  // Bodies that only move, or are warm and free to expand, are not strained: b asks for motions, and x is rounding.
  const double nothing = std::max(goal.negligible, Limits::part_that_is_nothing * rounding_of_error(run.problem.right.b, norm_));
  if (goal.allowed_error && result.error <= nothing && goal.energy_norm(z, result.nu) <= Limits::times_nothing * nothing)
    return true;
  // Infinite while points stick whose bounds are still to come.
  if (run.first_error == 0 && std::isfinite(result.error)) run.first_error = result.error;
  const bool small = worst <= (goal.allowed_error ? limits::Every::finest : goal.residual) * run.size || is_as_asked(run);
  bool solved = small && believable(result.error, rounding_of_error(run.problem.right.b, norm_), z, result.nu, goal,
                                    worst <= limits::Every::rounding * run.size);
  run.doubtful = small && !solved;
  std::optional<bool> converged;
  const auto contact = [&] {
    if (!converged) converged = contact_converged(run, natural);
    return *converged;
  };
  if (goal.allowed_error && !solved && std::isfinite(result.error)) {
    // What is allowed costs most to find and hardly changes from point to point: once known, it tells when to look again.
    const double part = to_come <= Limits::at_rest ? 1 : Limits::certain;
    if (run.allowed < 0 && (goal.exact > 0 || result.error <= Limits::first_look * run.first_error))
      run.allowed = (goal.expected_allowed_error ? goal.expected_allowed_error : goal.allowed_error)(z, result.nu);
    if (run.allowed >= 0 && result.error <= part * run.allowed && contact()) {
      run.allowed = goal.allowed_error(z, result.nu);
      solved = result.error <= part * run.allowed &&
               (worst <= limits::Every::largest_residual * run.size || believable(result.error, 0, z, result.nu, goal));
    }
  }
  if (!solved && goal.exact > 0 && goal.allowed_error && std::isfinite(result.error))
    solved = result.error <= goal.exact * goal.energy_norm(z, result.nu);
  if (!solved && run.since_best >= Limits::stands_still) solved = is_exact_but_for_residual(run);
  if (!solved) return false;
  if (!contact()) {
    run.doubtful = run.doubtful || !goal.allowed_error;  // the next active set has a smaller residual to come down to
    return false;
  }
  if ((!goal.allowed_error || radii_at_rest(run)) && is_compatible(run)) return true;
  run.doubtful = true;
  return false;
}

// Whether z is a direct solution whose residual rounding keeps above what was asked for.
bool FaceNewton::is_exact_but_for_residual(const Run& run) const
{
  const auto& goal = run.goal;
  const auto& result = run.result;
  if (!(goal.exact > 0) || goal.allowed_error || !std::isfinite(result.error)) return false;
  if (run.worst() > std::max(goal.residual, limits::Direct::rough_residual) * run.size) return false;
  return result.error <= goal.exact * goal.energy_norm(run.state.z, result.nu) && is_compatible(run);
}

// What the residual of a solution is relative to: see Solution::projected_gradient.
double FaceNewton::size_of_residuals(const Run& run) const
{
  const double work = std::max(run.state.z.dot(run.state.g) + run.state.z.dot(run.problem.right.b), 0.0);  // z'A z
  return std::max(run.size, Limits::least_size * std::sqrt(norm_ * work));
}

// Whether z has the residuals that were asked for, where rounding keeps them from becoming smaller.
bool FaceNewton::is_as_asked(const Run& run) const
{
  if (run.goal.allowed_error || run.since_best < Limits::stands_still) return false;
  const auto& [hessian, equality, right, set] = run.problem;
  const double size = size_of_residuals(run), asked = run.goal.residual;
  const double lacking = norm_ * equality.norm(right.e - equality.apply(run.state.z));
  return run.worst() <= asked * size && lacking <= std::max(asked, Limits::rounding_of_balance) * size;
}

// Whether z is a direct solution with an error that does not matter, whose contact forces are known, though not the states of
// points that hardly press: surfaces that lie on each other without a force. Rounding decides these, and what follows it leads
// away.
bool FaceNewton::is_exact_but_for_states(Run& run, const Projection& natural)
{
  const auto& goal = run.goal;
  if (!(goal.exact > 0) || !goal.allowed_error || !goal.incompatibility || !std::isfinite(run.result.error)) return false;
  if (run.exact_but_for_states && run.result.error >= run.exact_but_for_states->result.error) return false;
  if (run.allowed < 0) run.allowed = goal.allowed_error(run.state.z, run.result.nu);
  if (!(run.result.error <= Limits::certain * run.allowed) || run.worst() > limits::Every::largest_residual * run.size ||
      !radii_at_rest(run))
    return false;
  Projection firm{natural.point, Vector(natural.argument.getMap()), natural.nu};
  firm.argument.putScalar(std::numeric_limits<double>::infinity());  // as if all states were decided
  return contact_converged(run, firm) && goal.incompatibility(run.state.z, run.result.nu) <= limits::Every::nearly_compatible;
}

// Whether contact at z has converged, as far as the goal asks for that.
bool FaceNewton::contact_converged(const Run& run, const Projection& natural)
{
  const auto& goal = run.goal;
  const auto& z = run.state.z;
  // What A^-1 then makes of the residual is rounding among rows that depend on each other, as where three bodies meet.
  const bool settled = run.worst() <= (goal.exact > 0 ? Limits::residual_of_direct : limits::Every::rounding) * run.size;
  if (!goal.contact_converged || !preconditioner_ || settled) return true;
  // To a residual that is given, from a direct solution, or with nothing but rounding.
  if (!goal.allowed_error && (goal.exact > 0 || run.result.error <= rounding_of_error(run.problem.right.b, norm_))) return true;
  Vector gap(z, Teuchos::Copy), change(z.getMap());
  gap.update(-norm_, natural.point, norm_);
  preconditioner_->fix({}, {});
  preconditioner_->apply(gap, change);
  ++preconditionings_;
  return goal.contact_converged(z, natural.argument, change);
}

// Whether products, active sets or patience have run out.
bool FaceNewton::gives_up(Run& run) const
{
  const double worst = run.worst();
  const bool better = worst < Limits::better * run.best || (run.doubtful && run.result.error < Limits::better * run.best_error);
  run.since_best = better ? 0 : run.since_best + 1;
  run.best = std::min(run.best, worst);
  run.best_error = std::min(run.best_error, run.result.error);
  if (run.since_best > 1) run.active_set_tolerance *= 0.1;  // perhaps it is these that matter
  if (run.exact_but_for_states && run.result.error > Limits::away * run.exact_but_for_states->result.error) return true;
  return programme_.hessian.exhausted() || run.result.outer_iterations >= Limits::most_active_sets ||
         run.since_best >= (run.followed ? Limits::update_patience : Limits::patience) ||
         run.result.safeguards > Limits::most_safeguards;
}

// The residual to come down to on the next active set, if inner_reduction does not end it before.
double FaceNewton::residual_to_reach(const Run& run) const
{
  if (run.doubtful) return Limits::inner_reduction * run.worst();
  if (!run.goal.allowed_error)
    return (unconstrained_ ? Limits::below_goal_alone : Limits::below_goal) * run.goal.residual * run.size;
  if (run.allowed > 0) return Limits::below_allowed * run.worst() * std::min(1.0, run.allowed / run.result.error);
  return unconstrained_ ? Limits::inner_reduction * run.worst() : 0;
}

}  // namespace mortise::qp
