#include "qp/face_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "face_newton_run.hpp"
#include "qp/norm.hpp"
#include "rounding.hpp"

namespace mortise::qp {

namespace {

constexpr double longer_step = 20;       // times step_length: where bounds follow the solution, on what is not free
constexpr double constraint_weight = 4;  // over the step's length: what a force off its constraint counts beside gaps
constexpr int fruitless_sets = 2;        // that brought nothing better: from then on the preconditioner knows nothing of slip
constexpr int probes = 4;                // applications of the preconditioner that tell how stiff the point of a disc is
constexpr double norm_accuracy = 0.4;    // the step only picks the active set, and a descent is checked
constexpr double first_active_set_tolerance = 1e-3;  // distances from bounds, over the largest, that count as none
constexpr double first_active_set_tolerance_updated =
    1e-5;                               // the same where bounds follow the solution: the longer step picks better
constexpr double company = 3;           // so many times stiffer is a point to forces that its neighbours share: they slip, too
constexpr double max_recycled = 300;    // directions kept from one active set to the next, where they take less than
constexpr double recycled_bytes = 3e8;  // on each rank,
constexpr double more_bytes = 1e9;      // or up to so much,
constexpr double few_recycled = 60;     // so many,
constexpr double least_kept = 10;       // in any case

}  // namespace

FaceNewton::FaceNewton(const Programme& programme, ActiveSetPreconditioner* preconditioner)
    : programme_(programme), preconditioner_(preconditioner), projector_(programme.equality, programme.set)
{
  const auto& comm = programme.equality.communicator();
  const auto constraints = static_cast<long long>(programme.set.bounds().size() + programme.set.discs().size());
  unconstrained_ = comm.sum(constraints) == 0;
  // Three vectors each, and three more while an active set uses them.
  const double pair = 48.0 * static_cast<double>(programme.hessian.map()->getGlobalNumElements()) / comm.size();
  const double room = std::max(std::min(recycled_bytes / std::max(pair, 1.0), max_recycled),
                               std::min(more_bytes / std::max(pair, 1.0), few_recycled));
  kept_ = static_cast<std::size_t>(std::max(room, least_kept));
}

// The loop. How the next point is found is in face_newton_trial.cpp, how y is found on an active set in active_set_descent.cpp,
// when it ends in face_newton_goal.cpp.
Solution FaceNewton::solve(const RightHandSide& right, std::span<const double> radii, const SlipLaw* law,
                           const std::optional<Solution>& start, const Goal& goal, const Observer& observer)
{
  const auto map = programme_.hessian.map();
  FeasibleSet set = programme_.set.with_radii(radii);
  const Problem problem(programme_, right, set);
  std::optional<FollowedRadii> followed;
  if (law) followed.emplace(*law, set, programme_.equality.communicator());
  const auto infeasible = [&set](Solution result, const Projection& projection) {
    result.feasible = false;
    result.empty = projection.empty;
    result.nu = projection.nu;
    result.radii = set.radii();
    return result;
  };
  const Projection feasible = project(problem, start ? start->x : Vector(map));
  Solution result(feasible.point, Vector(map), feasible.nu);
  if (!feasible.found) return infeasible(std::move(result), feasible);
  preconditionings_ = 0;
  if (law && law->cautious) recycled_directions_.clear();  // they would lead where they have led before
  find_norm(start, observer);

  Run run{problem, start, goal, law ? &*followed : nullptr, observer, std::move(result), State(map), ContactForces(problem)};
  const double size = relative_size(problem, goal.allowed_error ? limits::Every::finest : goal.residual);
  if (size != 0) run.size = size;
  run.active_set_tolerance = law ? first_active_set_tolerance_updated : first_active_set_tolerance;
  if (start && start->nu.size() == problem.equality.size()) run.nu = start->nu * (step_length / norm_);
  auto& [z, g, y, gy] = run.state;
  z.assign(feasible.point);
  programme_.hessian.gradient(z, right, g);
  run.energy = energy_of(right.b, z, g);
  y.assign(z);
  gy.assign(g);
  while (true) {
    Trial trial = project_step(run);
    if (!trial.next.found)
      return infeasible(std::move(run.result), trial.next);  // bounds leave no point, for a start there was one
    evaluate(right, trial);
    improve_soft_start(run, trial);
    safeguard(run, trial);
    Judged judged = draw_back(run, trial);
    const Projection natural = accept(run, trial, std::move(judged));
    report(run, "outer", true);
    run.result.converged = is_solved(run, natural);
    if (run.result.converged || gives_up(run)) {
      if (!run.result.converged && run.exact_but_for_states) run.go_back();
      if (std::isnan(run.result.error)) find_error(run, natural);
      if (!run.result.converged) run.result.converged = is_exact_but_for_residual(run);
      return solution_of(std::move(run));
    }
    if (is_exact_but_for_states(run, natural)) run.exact_but_for_states.emplace(run);
    minimise(run, trial);
  }
}

// ||P A P||, from an earlier solve if there was one.
void FaceNewton::find_norm(const std::optional<Solution>& start, const Observer& observer)
{
  if (norm_ != 0) return;
  norm_ = start && start->hessian_norm > 0 ? start->hessian_norm
                                           : projected_norm(programme_.hessian, programme_.equality, norm_accuracy);
  if (observer) observer({"norm", 0, programme_.hessian.count()});
  if (norm_ == 0) norm_ = 1;
  measure_discs();
}

// How stiff the point of each disc is alone, against which the curvatures of slip directions are measured: one over the diagonal
// of the preconditioner, which vectors of random signs tell about. No less compliance than 1 / ||P A P||.
void FaceNewton::measure_discs()
{
  const auto discs = programme_.set.discs();
  const auto wide = std::count_if(discs.begin(), discs.end(), [](const Disc& disc) { return disc.size() == 2; });
  disc_stiffness_.assign(discs.size(), norm_);
  if (!preconditioner_ || programme_.equality.communicator().sum(static_cast<long long>(wide)) == 0) return;
  const auto map = programme_.hessian.map();
  Vector signs(map), image(map);
  std::vector<double> sums(discs.size(), 0.0);
  preconditioner_->fix({}, {});
  for (int probe = 0; probe < probes; ++probe) {
    auto values = view(signs);
    for (const auto& disc : discs)
      for (int k = 0; k < disc.size(); ++k) {
        const Local i = disc.index[static_cast<std::size_t>(k)];
        std::minstd_rand random(static_cast<unsigned>(probes * map->getGlobalElement(i) + probe + 1));
        random.discard(3);
        values[i] = random() % 2 == 0 ? 1 : -1;
      }
    preconditioner_->apply(signs, image);
    ++preconditionings_;
    const auto felt = view(std::as_const(image));
    for (std::size_t d = 0; d < discs.size(); ++d)
      for (int k = 0; k < discs[d].size(); ++k) {
        const Local i = discs[d].index[static_cast<std::size_t>(k)];
        sums[d] += values[i] * felt[i] / (probes * discs[d].size());
      }
  }
  for (std::size_t d = 0; d < discs.size(); ++d) disc_stiffness_[d] = company / std::max(sums[d], 1 / norm_);
}

// z becomes the trial's point. Returns the natural projection there; sets the residual, the mismatch of radii and, if it is
// wanted, the error.
Projection FaceNewton::accept(Run& run, const Trial& trial, Judged judged)
{
  auto& z = run.state.z;
  auto& result = run.result;
  z.assign(trial.next.point);
  run.state.g.assign(trial.gradient);
  run.energy = trial.energy;
  run.nu = trial.next.nu * (step_length / norm_ / trial.step);
  run.active = run.problem.set.active(view(std::as_const(z)));

  Projection natural = std::move(judged.natural);
  run.residual = judged.residual;
  run.mismatch = judged.mismatch;
  result.nu = natural.nu * norm_;
  ++result.outer_iterations;
  run.size = std::max(run.size, rounding_of_motions(run, natural));
  const bool near = run.worst() <= run.goal.residual * run.size, slow = run.worst() >= Limits::better * run.best;
  result.error = std::numeric_limits<double>::quiet_NaN();
  if (run.goal.allowed_error || near || slow) find_error(run, natural);
  return natural;
}

// y becomes the solution on the active set that the trial picked, nearly.
void FaceNewton::minimise(Run& run, const Trial& trial)
{
  const bool follow = run.followed != nullptr;
  const ActiveSet active_set(projector_, run.problem.set, trial.next.argument, run.beyond ? longer_step * trial.step : trial.step,
                             disc_stiffness_, run.active_set_tolerance, follow);
  const bool curved = run.since_best < fruitless_sets;
  if (preconditioner_)
    preconditioner_->fix(active_set.fixed(), curved ? std::span(active_set.slips()) : std::span<const SlipDirection>());
  const double enough = residual_to_reach(run);
  // Where the last active set was picked badly, what others know leads astray: cells of aspect 1000 tell little of each other.
  const bool trusted = follow || (trial.part_of_way == 1 && run.since_best == 0);
  const double weight = constraint_weight * norm_ / (follow ? longer_step * step_length : step_length);
  const auto watch = [&] { report(run, "inner", false); };
  run.moved = unconstrained_ ? descend_alone(active_set, enough, watch, run.state)
                             : descend(active_set, enough, weight, trusted, watch, run.state);
  if (follow) {
    run.beyond.emplace(long_gradient_step(active_set, run.state.y, run.state.gy));
    run.beyond_z.emplace(long_gradient_step(active_set, run.state.z, run.state.g));
    run.nu.setZero();  // it has gone into that
  }
}

// Where the next projection begins if bounds follow the solution: y less a step along its gradient that is long where the active
// set says what x is and short where x is free. What y takes out of Omega is made up for by forces at all points of a subdomain,
// as if they were nearer by as much over the length of the step: the longer it is, the fewer points without force are caught.
// Along free unknowns it would only carry on what conjugate residuals have left.
Vector FaceNewton::long_gradient_step(const ActiveSet& active_set, const Vector& y, const Vector& gy) const
{
  const double step = step_length / norm_;
  Vector reaction(gy, Teuchos::Copy);
  const Vector residual = active_set.reduce(reaction);
  Vector beyond(y, Teuchos::Copy);
  beyond.update(-longer_step * step, reaction, (longer_step - 1) * step, residual, 1);
  // Slip that goes back sticks first: nobody crosses the disc to slip in the opposite direction.
  const auto from = view(y);
  auto to = view(beyond);
  for (const auto& disc : programme_.set.discs()) {
    if (!(disc.coefficient > 0)) continue;
    const Eigen::Vector2d start = from_centre(disc, from), way = from_centre(disc, to) - start;
    const double part = -start.dot(way) / std::max(way.squaredNorm(), std::numeric_limits<double>::min());
    const Eigen::Vector2d nearest = start + part * way;
    if (part <= 0 || part >= 1 || nearest.norm() >= disc.coefficient * std::max(from[disc.normal], 0.0)) continue;
    for (int k = 0; k < disc.size(); ++k) to[disc.index[static_cast<std::size_t>(k)]] -= (1 - part) * way[k];
  }
  return beyond;
}

// What the last point of a run is as a solution.
Solution FaceNewton::solution_of(Run run) const
{
  const auto& [z, g, y, gy] = run.state;
  const auto& [hessian, equality, right, set] = run.problem;
  auto& result = run.result;
  result.x.assign(z);
  result.gradient.assign(g);
  result.hessian_norm = norm_;
  result.preconditionings = preconditionings_;
  result.radii = set.radii();
  result.projected_gradient = run.residual / size_of_residuals(run);
  result.equality = equality.size() > 0 ? equality.norm(right.e - equality.apply(z)) * norm_ / run.size : 0.0;
  return std::move(result);
}

// One product.
void FaceNewton::evaluate(const RightHandSide& right, Trial& trial) const
{
  programme_.hessian.gradient(trial.next.point, right, trial.gradient);
  trial.energy = energy_of(right.b, trial.next.point, trial.gradient);
}

void FaceNewton::report(const Run& run, const char* what, bool outer) const
{
  if (run.observer)
    run.observer({what, run.result.outer_iterations, programme_.hessian.count(), run.residual / run.size, run.mismatch / run.size,
                  0, run.active, preconditionings_, run.energy, run.result.error, outer ? &run.state.z : nullptr,
                  outer ? &run.problem.set : nullptr, run.allowed > 0 ? run.allowed : std::numeric_limits<double>::quiet_NaN()});
}

}  // namespace mortise::qp
