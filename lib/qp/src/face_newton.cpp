#include "qp/face_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qp/error_estimate.hpp"
#include "qp/norm.hpp"

namespace mortise::qp {

namespace {

constexpr double longer_step = 20;       // times step_length: where bounds follow the solution, on what is not free
constexpr double safe_length = 1.5;      // of the step that is sure to descend
constexpr double constraint_weight = 4;  // over the step's length: what a force off its constraint counts beside gaps
constexpr double slip_stiffness = 0.1;   // curvatures of slip directions are measured against this part of ||P A P||
constexpr double norm_accuracy = 0.4;    // the step only picks the active set, and a descent is checked
constexpr int max_active_sets = 200;
constexpr double first_active_set_tolerance = 1e-3;  // distances from bounds, over the largest, that count as none
constexpr double first_active_set_tolerance_updated =
    1e-5;                                 // the same where bounds follow the solution: the longer step picks better
constexpr double longer = 4.0;            // from one of the steps that a start is looked for with to the next
constexpr double soft = 0.25;             // curvature along the first step over ||P A P|| below which one is looked for
constexpr int max_starts = 10;            // attempts
constexpr int patience = 20;              // active sets without a better residual after which it gives up
constexpr int update_patience = 10;       // the same where slip bounds move, for then there is another way
constexpr std::size_t max_recycled = 60;  // directions kept from one active set to the next
constexpr double recycled_bytes = 1e9;    // that they may take of each rank; at least 10 are kept
constexpr int max_updates = 2;            // updates of slip bounds by a projection's own normal forces
constexpr int max_retreats = 8;           // of slip bounds
constexpr int max_retreats_to_z = 2;      // quarters of the way back, before the step becomes a gradient projection
constexpr int max_safeguards = 12;        // after which another algorithm will do better
constexpr double at_rest = 0.05;          // of normal forces: change that is still to come
constexpr double certain = 0.1;           // of the allowed error, at which their change does not matter
constexpr double least_size = 0.01;  // of ||A||^1/2 ||x||_A: where b asks for nearly nothing, ||P b|| is no measure of residuals
constexpr double first_look = 0.1;   // part of the first error at which the allowed one is asked for

// Whether normal forces are at rest: by how much they are still to change, if they change like the error.
class ContactForces {
 public:
  explicit ContactForces(const Problem& problem) : problem_(problem) {}

  // Relative, of the forces at x, whose error is `error`; infinite where that cannot be told. Collective.
  double change_to_come(const Vector& x, double error)
  {
    const auto values = view(x);
    std::vector<double> now;
    std::vector<double> sums(2, 0.0);
    for (const auto& bound : problem_.set.bounds()) {
      now.push_back(values[bound.index]);
      sums[0] += now.back() * now.back();
      if (!before_.empty()) sums[1] += std::pow(now.back() - before_[now.size() - 1], 2);
    }
    problem_.equality.communicator().sum_in_place(sums);
    const double part = error / error_;
    const bool known = error_ > 0 && part < 1;
    before_ = std::move(now);
    error_ = error;
    if (sums[0] == 0 || sums[1] == 0) return known || sums[0] == 0 ? 0.0 : std::numeric_limits<double>::infinity();
    return known ? std::sqrt(sums[1] / sums[0]) * part / (1 - part) : std::numeric_limits<double>::infinity();
  }

 private:
  const Problem& problem_;
  std::vector<double> before_;
  double error_ = 0;
};

}  // namespace

FaceNewton::FaceNewton(const Problem& problem, ActiveSetPreconditioner* preconditioner)
    : problem_(problem), preconditioner_(preconditioner), projector_(problem.equality, problem.set)
{
  const auto constraints = static_cast<long long>(problem.set.bounds().size() + problem.set.discs().size());
  unconstrained_ = problem.equality.communicator().sum(constraints) == 0;
  // Three vectors each, and three more while an active set uses them.
  const double pair = 48.0 * static_cast<double>(problem.linear.getGlobalLength()) / problem.equality.communicator().size();
  kept_ = static_cast<std::size_t>(std::clamp(recycled_bytes / std::max(pair, 1.0), 10.0, static_cast<double>(max_recycled)));
}

// Where the next projection begins if bounds follow the solution: y less a step along its gradient that is long where the active
// set says what x is and short where x is free. What y takes out of Omega is made up for by forces at all points of a subdomain,
// as if they were nearer by as much over the length of the step: the longer it is, the fewer points without force are caught.
// Along free unknowns it would only carry on what conjugate residuals have left.
Vector FaceNewton::long_gradient_step(const ActiveSet& active_set, const State& state) const
{
  const double step = step_length / norm_;
  Vector reaction(state.gy, Teuchos::Copy);
  const Vector residual = active_set.reduce(reaction);
  Vector beyond(state.y, Teuchos::Copy);
  beyond.update(-longer_step * step, reaction, (longer_step - 1) * step, residual, 1);
  // Slip that goes back sticks first: nobody crosses the disc to slip in the opposite direction.
  const auto from = view(std::as_const(state.y));
  auto to = view(beyond);
  for (const auto& disc : problem_.set.discs()) {
    if (!(disc.coefficient > 0)) continue;
    const Eigen::Vector2d start = from_centre(disc, from), way = from_centre(disc, to) - start;
    const double part = -start.dot(way) / std::max(way.squaredNorm(), std::numeric_limits<double>::min());
    const Eigen::Vector2d nearest = start + part * way;
    if (part <= 0 || part >= 1 || nearest.norm() >= disc.coefficient * std::max(from[disc.normal], 0.0)) continue;
    for (int k = 0; k < disc.size(); ++k) to[disc.index[static_cast<std::size_t>(k)]] -= (1 - part) * way[k];
  }
  return beyond;
}

// Whether the curvature of A from a to b, where A x - b is ga and gb, is far below ||P A P||.
bool FaceNewton::soft_between(const Vector& a, const Vector& ga, const Vector& b, const Vector& gb) const
{
  Vector d(b, Teuchos::Copy), ad(gb, Teuchos::Copy);
  d.update(-1, a, 1);
  ad.update(-1, ga, 1);
  return d.dot(ad) < soft * norm_ * d.dot(d);
}

// The feasible point nearest to 0 spreads forces over all points of a contact, also over those with wide gaps. Points nearest to
// ever longer steps along b know the gaps: z becomes the one of least energy, as long as it falls below `energy`. One product
// each. Returns whether there is one.
bool FaceNewton::improve_start(State& state, double energy)
{
  auto& [z, g, y, gy] = state;
  auto& hessian = problem_.hessian;
  const auto& linear = problem_.linear;
  Vector downhill(linear, Teuchos::Copy);
  problem_.equality.project(downhill);
  double step = step_length / norm_;
  bool found = false;
  for (int attempt = 0; attempt < max_starts && !hessian.exhausted(); ++attempt) {
    step *= longer;
    Vector trial(downhill, Teuchos::Copy);
    trial.scale(step);
    const Projection next = projector_(trial);
    if (!next.found) break;
    hessian.apply(next.point, gy);
    gy.update(-1, linear, 1);
    const double next_energy = 0.5 * (next.point.dot(gy) - next.point.dot(linear));
    if (!(next_energy < energy)) break;
    z.assign(next.point);
    g.assign(gy);
    energy = next_energy;
    found = true;
  }
  y.assign(z);
  gy.assign(g);
  return found;
}

Solution FaceNewton::solve(const std::optional<Solution>& start, const Goal& goal, const SlipBoundUpdate* slip_bound_update,
                           const Observer& observer)
{
  auto& [hessian, linear, equality, set, driven] = problem_;
  const auto map = hessian.map();
  Projection feasible = projector_(start ? start->x : Vector(map));
  Solution result(feasible.point, Vector(map), feasible.nu);
  if (!feasible.found) {
    result.feasible = false;
    result.empty = feasible.empty;
    return result;
  }
  preconditionings_ = 0;
  if (norm_ == 0) {
    norm_ = start && start->hessian_norm > 0 ? start->hessian_norm : projected_norm(hessian, equality, norm_accuracy);
    if (observer) observer({"norm", 0, hessian.count()});
    if (norm_ == 0) norm_ = 1;
  }
  double size = relative_size(problem_, goal.allowed_error ? tolerances::finest : goal.residual);
  if (size == 0) size = 1;

  State state(map);
  auto& [z, g, y, gy] = state;
  const auto evaluate = [&](const Vector& at, Vector& gradient) {
    hessian.apply(at, gradient);
    gradient.update(-1, linear, 1);
  };
  const auto energy_of = [&](const Vector& at, const Vector& gradient) { return 0.5 * (at.dot(gradient) - at.dot(linear)); };
  z.assign(feasible.point);
  evaluate(z, g);

  double energy = energy_of(z, g);
  y.assign(z);
  gy.assign(g);
  double residual = 0, mismatch = 0, best = std::numeric_limits<double>::infinity(), best_error = best;
  int since_best = 0;
  FeasibleSet::Active active{};
  const auto report = [&](const char* what, bool outer = false) {
    if (observer)
      observer({what, result.outer_iterations, hessian.count(), residual / size, mismatch / size, 0, active, preconditionings_,
                energy, result.error, outer ? &z : nullptr});
  };
  Eigen::VectorXd nu =
      start && start->nu.size() == equality.size() ? Eigen::VectorXd(start->nu * (step_length / norm_)) : Eigen::VectorXd();
  bool moved = false;            // y differs from z
  std::optional<Vector> beyond;  // y after a longer step, where bounds follow the solution
  double active_set_tolerance = slip_bound_update ? first_active_set_tolerance_updated : first_active_set_tolerance;
  double first_error = 0, allowed = -1;  // negative: not asked for yet
  bool doubtful = false;                 // a small residual beside a large error
  ContactForces contact(problem_);
  while (true) {
    double step = step_length / norm_;
    Vector trial(y, Teuchos::Copy);
    if (beyond)
      trial.assign(*beyond);
    else
      trial.update(-step, gy, 1);
    if (slip_bound_update && result.outer_iterations > 0) slip_bound_update->update(y, true);
    Projection next = projector_(trial, nu);
    // The normal forces that the projection changes change the bounds once more.
    for (int pass = 0; slip_bound_update && result.outer_iterations > 0 && next.found && pass < max_updates; ++pass) {
      slip_bound_update->update(next.point, true);
      next = projector_(trial, next.nu);
    }
    for (int retreat = 0; slip_bound_update && !next.found && retreat < max_retreats; ++retreat) {
      slip_bound_update->retreat();
      next = projector_(trial, nu);
    }
    if (!next.found) {  // bounds that leave no feasible point, for a start there was one
      result.feasible = false;
      result.empty = next.empty;
      result.nu = next.nu;
      return result;
    }
    Vector gradient(map);
    evaluate(next.point, gradient);
    double next_energy = energy_of(next.point, gradient);
    if (!start && !unconstrained_ && result.outer_iterations == 0 && soft_between(z, g, next.point, gradient) &&
        improve_start(state, next_energy)) {
      energy = energy_of(z, g);
      trial.update(1, z, -step, g, 0);
      if (Projection onward = projector_(trial); onward.found) {
        next = std::move(onward);
        evaluate(next.point, gradient);
        next_energy = energy_of(next.point, gradient);
      }
    }
    // Where the active set was picked badly the minimiser on it is far away: go back towards z until the function falls.
    double part = 1;
    for (int attempt = 0; !slip_bound_update && moved && next_energy > energy + 1e-9 * std::abs(energy) && !hessian.exhausted();
         ++attempt) {
      part = attempt < max_retreats_to_z ? part * 0.25 : 0;
      step = part > 0 ? step : safe_length / norm_;
      trial.update(1 - part, z, part, y, 0);
      trial.update(-step * (1 - part), g, -step * part, gy, 1);
      next = projector_(trial, Eigen::VectorXd(nu * (step * norm_ / step_length)));
      evaluate(next.point, gradient);
      next_energy = energy_of(next.point, gradient);
      ++result.safeguards;
      if (part == 0) break;
    }
    z.assign(next.point);
    g.assign(gradient);
    energy = next_energy;
    nu = next.nu * (step_length / norm_ / step);
    active = set.active(view(std::as_const(z)));

    trial.assign(z);
    trial.update(-1 / norm_, g, 1);
    const Projection natural = projector_(trial, Eigen::VectorXd(nu / step_length));
    trial.update(1, z, -1, natural.point, 0);
    residual = trial.norm2() * norm_;
    mismatch = slip_bound_update ? slip_bound_update->update(z, false) * norm_ / step_length : 0.0;
    result.nu = natural.nu * norm_;
    ++result.outer_iterations;
    const double worst = std::max(residual, mismatch);
    result.error = error_bound(problem_, z, natural, norm_, preconditioner_) * (residual > 0 ? worst / residual : 1.0);
    preconditionings_ += preconditioner_ ? 1 : 0;
    report("outer", true);
    const double to_come = contact.change_to_come(z, result.error);
    // Infinite while points stick whose bounds are still to come.
    if (first_error == 0 && std::isfinite(result.error)) first_error = result.error;
    const bool small = worst <= (goal.allowed_error ? tolerances::finest : goal.residual) * size;
    result.converged = small && believable(result.error, rounding_of_error(problem_, norm_), z, result.nu, goal,
                                           worst <= tolerances::rounding * size);
    doubtful = small && !result.converged;
    if (goal.allowed_error && !result.converged && std::isfinite(result.error) &&
        result.error <= (allowed < 0 ? first_look * first_error : allowed)) {
      allowed = goal.allowed_error(z, result.nu);
      result.converged = result.error <= (to_come <= at_rest ? 1 : certain) * allowed &&
                         (worst <= Goal::largest_residual * size || believable(result.error, 0, z, result.nu, goal));
    }
    if (goal.allowed_error && result.converged && goal.contact_converged && preconditioner_) {
      Vector gap(z, Teuchos::Copy), change(map);
      gap.update(-norm_, natural.point, norm_);
      preconditioner_->fix({});
      preconditioner_->apply(gap, change);
      ++preconditionings_;
      result.converged = goal.contact_converged(z, natural.argument, change);
    }
    if (!result.converged && goal.exact > 0 && std::isfinite(result.error))
      result.converged = result.error <= goal.exact * goal.energy_norm(z, result.nu);
    since_best = worst < 0.9 * best || (doubtful && result.error < 0.9 * best_error) ? 0 : since_best + 1;
    best = std::min(best, worst);
    best_error = std::min(best_error, result.error);
    if (since_best > 1) active_set_tolerance *= 0.1;  // perhaps it is these that matter
    if (result.converged || hessian.exhausted() || result.outer_iterations >= max_active_sets ||
        since_best >= (slip_bound_update ? update_patience : patience) || result.safeguards > max_safeguards)
      break;

    const ActiveSet active_set(projector_, next.argument, beyond ? longer_step * step : step, slip_stiffness * norm_,
                               active_set_tolerance, slip_bound_update != nullptr);
    if (preconditioner_) preconditioner_->fix(active_set.fixed());
    // The residual to come down to on this face, if inner_reduction does not end it before.
    double enough = 0;
    if (doubtful)
      enough = inner_reduction * worst;
    else if (!goal.allowed_error)
      enough = (unconstrained_ ? 0.5 : 0.1) * goal.residual * size;
    else if (allowed > 0)
      enough = 0.3 * worst * std::min(1.0, allowed / result.error);
    else if (unconstrained_)
      enough = inner_reduction * worst;
    // Where the last active set was picked badly, what others know leads astray: cells of aspect 1000 tell little of each other.
    const bool trusted = slip_bound_update || (part == 1 && since_best == 0);
    const double weight = constraint_weight * norm_ / (slip_bound_update ? longer_step * step_length : step_length);
    const auto watch = [&] { report("inner"); };
    moved = unconstrained_ ? descend_alone(active_set, enough, watch, state)
                           : descend(active_set, enough, weight, trusted, watch, state);
    if (slip_bound_update) {
      beyond.emplace(long_gradient_step(active_set, state));
      nu.setZero();  // it has gone into that
    }
  }
  result.x.assign(z);
  result.gradient.assign(g);
  result.hessian_norm = norm_;
  result.preconditionings = preconditionings_;
  const double work = std::max(z.dot(g) + z.dot(linear), 0.0);  // z'A z
  result.projected_gradient = residual / std::max(size, least_size * std::sqrt(norm_ * work));
  result.equality = equality.size() > 0 ? equality.norm(equality.right_side() - equality.apply(z)) * norm_ / size : 0.0;
  return result;
}

}  // namespace mortise::qp
