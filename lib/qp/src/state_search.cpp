// Ways that lead near the states of constraints at a solution, and their order.
#include "state_search.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"

namespace mortise::qp {

namespace {

constexpr double softest = 0.1;          // of what a point gives way together with all others
constexpr double hardest = 1e-4;         // softness that is as good as none
constexpr double stride = 0.1;           // from one softness to the next
constexpr double least_stride = 0.8;     // as slow as it gets,
constexpr double largest_stride = 1e-4;  // and as fast, where
constexpr int at_once = 2;               // guesses were enough
constexpr double end_in_vain = 0.1;      // of the residual of what is solved: what products then show needs no more of them

using Eigen::VectorXd;

}  // namespace

StateSearch::StateSearch(CondensedProgramme programme, bool patient)
    : programme_(std::move(programme)),
      states_(programme_.all_closed()),
      sparing_(programme_.system().costly()),
      patient_(patient)
{
  point_.x = VectorXd::Zero(programme_.unknowns());
  point_.nu = VectorXd::Zero(programme_.motions());
  if (programme_.unknowns() > 0) softest_ = softest * programme_.system().largest_ratio();
}

std::vector<Local> StateSearch::free_forces() const
{
  std::vector<Local> unknowns;
  const auto bounds = programme_.set().bounds();
  const auto discs = programme_.set().discs();
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (states_.closed[i]) unknowns.push_back(bounds[i].index);
  for (std::size_t d = 0; d < discs.size(); ++d)
    for (int k = 0; k < discs[d].size() && states_.kind[d] == ConstraintStates::Kind::sticks; ++k)
      unknowns.push_back(discs[d].index[static_cast<std::size_t>(k)]);
  return unknowns;
}

bool StateSearch::from_anywhere()
{
  if (!sparing_) return find_patiently();
  const bool found = find_sparingly();
  if (!patient_ || programme_.motions() > Limits::few_motions || (found && point_.settled)) return found;
  // States that rounding decides, or none: as with small dense matrices.
  const auto point = point_;
  const auto states = states_;
  const double before = found ? off() : std::numeric_limits<double>::infinity();
  sparing_ = false;
  try {
    if (find_patiently() && (point_.settled || off() <= before)) return true;
  } catch (const Error& error) {
    if (error.status() != ExitStatus::not_converged) throw;
  }
  if (!found) return false;
  point_ = point;
  states_ = states;
  return true;
}

bool StateSearch::find_patiently()
{
  if (guess(Limits::look_back_at_first)) return true;
  if (programme_.unknowns() == 0 || slides()) return false;
  const bool small = programme_.unknowns() <= Limits::few_unknowns,
             very_small = programme_.unknowns() <= Limits::very_few_unknowns;
  const bool near_enough = small || softest_ <= Limits::soft_for_large_ones;
  const bool costly = programme_.system().costly();
  if (near_enough && harden(small ? INT_MAX : Limits::guesses_of_path, 1)) return true;
  if (point_.slides) return false;
  if (follow_path() || (small && repeat_paths()) || (very_small && change_steps())) return true;
  return harden(small && !costly ? affordable_guesses() : Limits::guesses_of_path, INT_MAX);
}

// By few factors, or a singular one.
bool StateSearch::find_sparingly()
{
  try {
    return (programme_.linear() && guess(to_the_end)) || follow_path() || repeat_paths();
  } catch (const Error& error) {
    if (error.status() != ExitStatus::not_converged) throw;
    return false;
  }
}

// Guesses that fit into `most_operations`, each a factor of W.
int StateSearch::affordable_guesses() const
{
  const auto n = static_cast<double>(programme_.unknowns());
  return static_cast<int>(std::min(Limits::most_operations / (2 * n * n * n / 3), 1e4));
}

// Guesses from a soft contact on, which becomes harder as fast as they converge, and slower where they do not; until they are
// `guesses`, or have not converged `failures` times. The next call goes on from there.
bool StateSearch::harden(int guesses, int failures)
{
  if (!soft_) {
    states_ = programme_.all_closed();
    point_.nu.setZero();
    programme_.soften(softest_);
    guess(to_the_end);
    soft_ = Soft{softest_, stride, states_, point_.nu};
  }
  auto& [softness, part, states, nu] = *soft_;
  while (softness > 0 && guesses > 0 && failures > 0) {
    const double next = softness * part > hardest ? softness * part : 0;
    const int before = point_.steps;
    states_ = states;
    point_.nu = nu;
    programme_.soften(next);
    const bool converged = guess(to_the_end), slowest = part >= least_stride;
    const int taken = point_.steps - before;
    if (unbounded_) {  // nothing harder will converge from there, unless it is what stops them
      programme_.soften(0);
      if (guess(to_the_end)) return true;
      if (slides()) return false;
    }
    guesses -= taken;
    failures -= !converged;
    if (!converged && slowest && next == 0) break;
    if (!converged && !slowest) {
      part = std::sqrt(part);
      continue;
    }
    if (converged) part = std::max(taken <= at_once ? largest_stride : stride, part * part);
    softness = next;
    states = states_;
    nu = point_.nu;
  }
  programme_.soften(0);
  return softness == 0;
}

// The point of a soft contact that is closed.
void StateSearch::start_soft()
{
  point_.nu.setZero();
  programme_.soften(softest_);
  programme_.solve(programme_.all_closed(), point_.x, point_.nu);
  programme_.soften(0);
}

// Along a path until `is_end` of a point, its product is `last` over the first, or it leads nowhere. Whether it was the first.
template <class Visit>
bool StateSearch::walk(CentralPath& path, double last, const Visit& is_end)
{
  const auto halved = [](const CentralPath::Distance& now, const CentralPath::Distance& before) {
    return 2 * now.product <= before.product || (2 * now.forces <= before.forces && 2 * now.motions <= before.motions);
  };
  std::vector<CentralPath::Distance> points{path.distance()};
  while (static_cast<int>(points.size()) < Limits::most_on_path && points.back().product > last * points[0].product &&
         path.advance()) {
    if (is_end()) return true;
    points.push_back(path.distance());
    const auto count = points.size();
    if (count > Limits::stuck_on_path && !halved(points.back(), points[count - 1 - Limits::stuck_on_path])) break;
  }
  return false;
}

// Guesses from points of the central path that come near. With factors these end at once if no fewer states are wrong than at a
// point before, and the path alone ends the search: where rows depend on each other states are what nobody can tell.
bool StateSearch::follow_path()
{
  start_soft();
  auto path = programme_.path_from(point_.x, point_.nu);
  double wanted = sparing_ ? Limits::path_nearer * Limits::path_near : Limits::path_near;
  int fewer = INT_MAX;  // changes than half of those that guesses began with before
  bool ended = false, in_vain = false;
  walk(path, 0, [&] {
    ++point_.steps;
    const double now = programme_.residual(path.x(), path.nu()) / programme_.size(path.x());
    if (now <= wanted) {
      wanted = Limits::path_nearer * now;
      point_.x = path.x(), point_.nu = path.nu();
      states_ = programme_.states(point_.x, point_.nu);
      ended = guess(now <= Limits::settled ? to_the_end
                    : sparing_             ? Limits::look_back_at_first
                                           : Limits::look_back_on_path,
                    fewer);
      in_vain = sparing_ && first_changes_ > fewer;
      if (sparing_) fewer = first_changes_ / 2;
    }
    return ended || (in_vain && now <= Limits::settled * end_in_vain);
  });
  if (ended || !sparing_) return ended;
  point_.x = path.x(), point_.nu = path.nu();
  states_ = programme_.states(point_.x, point_.nu);
  point_.settled = off() <= Limits::flutter;
  return off() <= Limits::end_of_costly_path;
}

// Coulomb's law by radii that are given, those of the normal forces before: each of these programmes is convex, so its path leads
// to its solution, and where rows depend on each other to the middle of all.
bool StateSearch::repeat_paths()
{
  if (!programme_.follows()) return false;
  const bool costly = sparing_;
  start_soft();
  double best = std::numeric_limits<double>::infinity(), wanted = costly ? Limits::worth_a_guess : Limits::path_near;
  VectorXd nearest_x, nearest_nu;
  for (int since_best = 0; since_best < (costly ? Limits::patience_with_costly_radii : Limits::patience_with_radii);) {
    auto path = programme_.path_with_radii(point_.x, point_.nu);
    walk(path, costly ? Limits::end_of_rough_path : Limits::end_of_path, [&] {
      ++point_.steps;
      return false;
    });
    point_.x = path.x(), point_.nu = path.nu();
    const double now = off();
    if (!std::isfinite(now)) return false;
    states_ = programme_.states(point_.x, point_.nu);
    point_.settled = now <= Limits::flutter;
    if (now <= Limits::settled_on_path) return true;
    if (now <= wanted) {
      if (guess(Limits::look_back_at_first)) return true;
      point_.x = path.x(), point_.nu = path.nu();
      if (!costly) wanted = Limits::path_nearer * now;
    }
    since_best = now < Limits::nearer * best ? 0 : since_best + 1;
    if (now < best) best = now, nearest_x = point_.x, nearest_nu = point_.nu;
    if (best > Limits::rounded_on_path || since_best < Limits::in_vain) continue;
    point_.x = std::move(nearest_x), point_.nu = std::move(nearest_nu);
    point_.settled = false;
    states_ = programme_.states(point_.x, point_.nu);
    return true;
  }
  return false;
}

// States are guessed from x - step s. Guesses that take turns with one step may not with another, longer or shorter.
bool StateSearch::change_steps()
{
  for (const double scale : {0.1, 10.0, 0.01, 0.3, 1e-3, 0.03}) {
    states_ = programme_.all_closed();
    point_.nu.setZero();
    programme_.soften(0, scale);
    const bool converged = guess(to_the_end);
    programme_.soften(0);
    if (converged && guess(to_the_end)) return true;
  }
  return false;
}

}  // namespace mortise::qp
