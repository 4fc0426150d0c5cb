// The next point of face Newton: a step that is projected, from a better start where the first one was soft, and on the way back
// where it went too far.
#include <algorithm>
#include <cmath>

#include "face_newton_run.hpp"
#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

constexpr double safe_length = 1.5;   // of the step that is sure to descend
constexpr double longer = 4.0;        // from one of the steps that a start is looked for with to the next
constexpr double soft = 0.25;         // curvature along the first step over ||P A P|| below which one is looked for
constexpr int max_starts = 10;        // attempts
constexpr int max_updates = 2;        // updates of slip bounds by a projection's own normal forces
constexpr int max_retreats = 8;       // of slip bounds
constexpr double least_part = 0.05;   // of the way, where bounds follow: less is none
constexpr double first_rise = 3;      // over the last residuals, as long as these are few
constexpr int max_retreats_to_z = 2;  // quarters of the way back, before the step becomes a gradient projection

}  // namespace

// Projects a step from y, which follows the gradient there or, where bounds follow the solution, is `beyond`. Those bounds are
// updated on the way, and taken back where they leave no feasible point; if that does not help either, none is found.
FaceNewton::Trial FaceNewton::project_step(Run& run)
{
  const double step = step_length / norm_;
  Vector to(run.state.y, Teuchos::Copy);
  if (run.beyond)
    to.assign(*run.beyond);
  else
    to.update(-step, run.state.gy, 1);
  return project_step(run, to, run.first() ? nullptr : &run.state.y);
}

// The same to a given place; bounds that follow the solution begin at those of `radii_at`, if that is given.
FaceNewton::Trial FaceNewton::project_step(Run& run, const Vector& to, const Vector* radii_at)
{
  auto* const bounds = run.followed;
  const bool follow = bounds && radii_at;
  if (follow) bounds->update(*radii_at, true);
  Projection next = project(run.problem, to, run.nu);
  // The normal forces that the projection changes change the bounds once more.
  for (int pass = 0; follow && next.found && pass < max_updates; ++pass) {
    bounds->update(next.point, true);
    next = project(run.problem, to, next.nu);
  }
  for (int retreat = 0; bounds && !next.found && retreat < max_retreats; ++retreat) {
    bounds->retreat();
    next = project(run.problem, to, run.nu);
  }
  return {std::move(next), step_length / norm_, Vector(run.state.y.getMap())};
}

// A first step along which the curvature is small says that there is a better start: the step is taken again from there.
void FaceNewton::improve_soft_start(Run& run, Trial& trial)
{
  auto& [z, g, y, gy] = run.state;
  if (run.start || unconstrained_ || !run.first()) return;
  if (!soft_between(z, g, trial.next.point, trial.gradient) || !improve_start(run.problem, run.state, trial.energy)) return;
  run.energy = energy_of(run.problem.right.b, z, g);
  Vector to(z, Teuchos::Copy);
  to.update(-trial.step, g, 1);
  if (Projection onward = project(run.problem, to); onward.found) {
    trial.next = std::move(onward);
    evaluate(run.problem.right, trial);
  }
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
bool FaceNewton::improve_start(const Problem& problem, State& state, double energy)
{
  auto& [z, g, y, gy] = state;
  const Vector& b = problem.right.b;
  Vector downhill(b, Teuchos::Copy);
  problem.equality.project(downhill);
  double step = step_length / norm_;
  bool found = false;
  for (int attempt = 0; attempt < max_starts && !programme_.hessian.exhausted(); ++attempt) {
    step *= longer;
    Vector trial(downhill, Teuchos::Copy);
    trial.scale(step);
    const Projection next = project(problem, trial);
    if (!next.found) break;
    programme_.hessian.gradient(next.point, problem.right, gy);
    const double next_energy = energy_of(b, next.point, gy);
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

// Where the active set was picked badly the minimiser on it is far away: goes back towards z until the function falls.
void FaceNewton::safeguard(Run& run, Trial& trial)
{
  const auto& [z, g, y, gy] = run.state;
  Vector to(z.getMap());
  for (int attempt = 0;
       !run.followed && run.moved && trial.energy > run.energy + 1e-9 * std::abs(run.energy) && !programme_.hessian.exhausted();
       ++attempt) {
    double& part = trial.part_of_way;
    part = attempt < max_retreats_to_z ? part * 0.25 : 0;
    trial.step = part > 0 ? trial.step : safe_length / norm_;
    to.update(1 - part, z, part, y, 0);
    to.update(-trial.step * (1 - part), g, -trial.step * part, gy, 1);
    trial.next = project(run.problem, to, Eigen::VectorXd(run.nu * (trial.step * norm_ / step_length)));
    evaluate(run.problem.right, trial);
    ++run.result.safeguards;
    if (part == 0) break;
  }
}

// The natural projection at the trial's point x, ||x - P_C(x - a g)|| / a being the residual.
FaceNewton::Judged FaceNewton::judge(const Run& run, const Trial& trial)
{
  const auto& x = trial.next.point;
  Vector to(x, Teuchos::Copy);
  to.update(-1 / norm_, trial.gradient, 1);
  Projection natural = project(run.problem, to, Eigen::VectorXd(trial.next.nu / (norm_ * trial.step)));
  to.update(1, x, -1, natural.point, 0);
  return {std::move(natural), to.norm2() * norm_, run.followed ? run.followed->update(x, false) * norm_ / step_length : 0.0};
}

// Where bounds follow the solution no energy falls, but a residual that rises above all of the last ones tells of an active set
// that was picked badly, whose solution is far away: goes back towards z then [Grippo, Lampariello and Lucidi, A nonmonotone line
// search technique for Newton's method, SIAM J. Numer. Anal. 23 (1986)].
FaceNewton::Judged FaceNewton::draw_back(Run& run, Trial& trial)
{
  Judged judged = judge(run, trial);
  if (!run.followed || !run.followed->cautious()) return judged;
  const auto& [z, g, y, gy] = run.state;
  Vector at(z.getMap()), to(z.getMap());
  const double allowed = run.highest() * (2 * run.last_residuals.size() < Run::remembered ? first_rise : 1.0);
  while (run.moved && run.beyond && judged.worst() > allowed && trial.part_of_way > 0 && !programme_.hessian.exhausted()) {
    const double part = trial.part_of_way > least_part ? trial.part_of_way * 0.25 : 0;
    at.update(1 - part, z, part, y, 0);
    to.update(1 - part, *run.beyond_z, part, *run.beyond, 0);
    Trial next = project_step(run, to, &at);
    if (!next.next.found) break;
    next.part_of_way = part;
    trial = std::move(next);
    evaluate(run.problem.right, trial);
    judged = judge(run, trial);
    ++run.result.safeguards;
  }
  if (run.last_residuals.size() == Run::remembered) run.last_residuals.pop_front();
  if (std::isfinite(judged.worst())) run.last_residuals.push_back(judged.worst());
  return judged;
}

}  // namespace mortise::qp
