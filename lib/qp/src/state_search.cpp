#include "state_search.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/interruption.hpp"

namespace mortise::qp {

namespace {

constexpr int max_guesses = 15;        // at one softness, and so many
constexpr int max_last_guesses = 60;   // once it is none: forces that hardly count settle late;
constexpr int idle_before_single = 4;  // guesses that have not brought fewer changes: from then on one place changes at a time,
constexpr int idle_single = 30;        // for so many more,
constexpr int max_single_guesses = 300;
constexpr int look_back_at_first = 4;  // guesses that must have halved changes, if these are more than so few
constexpr int look_back_on_path = 1;
constexpr int to_the_end = 0;
constexpr double few_changes = 0.02;             // of all constraints, or so few,
constexpr double handful = 8;                    // or so few in all
constexpr double nearly_right = 0.1;             // the same of states that another way has come to
constexpr int max_turns = 3;                     // of the slip at a point; then it sticks before it turns
constexpr double other_loads = 1e-3;             // residual over x of a solution before
constexpr double settled_residual = 1e-10;       // residual over x
constexpr double flutter = 1e-12;                // the same below which guesses differ by rounding
constexpr int most_polishing = 4;                // guesses more, as long as they make the residual smaller
constexpr double stalled = 0.5;                  // of the residual before: what rounding has left of it,
constexpr double rounded_residual = 1e-6;        // over x, which is no more than this, or than so many times
constexpr double roundings = 1e4;                // what rounding makes of W x,
constexpr int idle = 8;                          // and so many guesses have not brought fewer changes
constexpr int solved_again = 3;                  // guesses that solve the problem, whatever states the next one takes
constexpr double same_step = 1e-6;               // of motions that go on for ever
constexpr double way_out = 0.05;                 // of the slip, that a motion may open contact by and still be a slide
constexpr double residual_of_soft = 0.1;         // over x: what a soft contact is good for, it gives states to begin with
constexpr double softest = 0.1;                  // of what a point gives way together with all others
constexpr double hardest = 1e-4;                 // softness that is as good as none
constexpr double worse = 3;                      // times the residual before: such a step is shortened,
constexpr int halvings = 6;                      // so often at most
constexpr double stride = 0.1;                   // from one softness to the next
constexpr double least_stride = 0.8;             // as slow as it gets,
constexpr double largest_stride = 1e-4;          // and as fast, where
constexpr int at_once = 2;                       // guesses were enough
constexpr int most_on_path = 100;                // linear problems along the central path,
constexpr int stuck_on_path = 12;                // the last of so many must have halved tau, or what equations lack
constexpr double path_near = 1e-3;               // residual over x from which on guesses are tried from the path,
constexpr double path_nearer = 0.1;              // and of what it was then, to try again
constexpr Eigen::Index few_unknowns = 2000;      // up to which a factor of W takes a moment; beyond, as long as many guesses,
constexpr int guesses_of_path = 60;              // and a path of them as long as so many
constexpr Eigen::Index few_motions = 5000;       // up to which a sparse factor takes a moment
constexpr double soft_for_large_ones = 1e5;      // beyond, these take fewer steps along a path than strides to hardness
constexpr double most_operations = 3e12;         // of factors that a last search may take
constexpr Eigen::Index very_few_unknowns = 800;  // up to which steps of other lengths are tried: hundreds of guesses
constexpr int patience_with_radii = 6;           // radii in a row without a residual that is so much,
constexpr int patience_with_costly_radii = 1;    // with sparse matrices
constexpr double nearer = 0.7;                   // of the least before
constexpr double end_of_path = 1e-13;            // of the first product,
constexpr double end_of_rough_path = 1e-7;       // where guesses go on from it,
constexpr double worth_a_guess = 0.1;            // if the residual over x is so small
constexpr double end_of_costly_path = 1e-7;      // residual over x where guesses do not end it, and are all there is
constexpr double settled_on_path = 1e-9;         // residual over x at which radii are those of the forces,
constexpr double rounded_on_path = 1e-7;         // or no better,
constexpr int in_vain = 2;                       // with so many radii in a row

using Eigen::VectorXd;

// How many constraints are taken for something else; slip that turns for the fourth time sticks first.
int compare(const ConstraintStates& before, ConstraintStates& now, std::vector<int>& turns)
{
  using Kind = ConstraintStates::Kind;
  int changes = 0;
  for (std::size_t i = 0; i < now.closed.size(); ++i) changes += now.closed[i] != before.closed[i];
  for (std::size_t d = 0; d < now.kind.size(); ++d) {
    const bool turned =
        now.kind[d] == Kind::slips && before.kind[d] == Kind::slips && now.slip[d].direction.dot(before.slip[d].direction) < 0;
    if (turned && ++turns[d] > max_turns) now.kind[d] = Kind::sticks;
    changes += turned || now.kind[d] != before.kind[d];
  }
  return changes;
}

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

bool StateSearch::from_anywhere()
{
  if (!sparing_) return find_patiently();
  const bool found = find_sparingly();
  if (!patient_ || programme_.motions() > few_motions || (found && point_.settled)) return found;
  // States that rounding decides, or none: as with small dense matrices.
  const auto point = point_;
  const auto states = states_;
  sparing_ = false;
  try {
    if (find_patiently()) return true;
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
  if (guess(look_back_at_first)) return true;
  if (programme_.unknowns() == 0 || slides()) return false;
  const bool small = programme_.unknowns() <= few_unknowns, very_small = programme_.unknowns() <= very_few_unknowns;
  const bool near_enough = small || softest_ <= soft_for_large_ones;
  const bool costly = programme_.system().costly();
  if (near_enough && harden(small ? INT_MAX : guesses_of_path, 1)) return true;
  if (point_.slides) return false;
  if (follow_path() || (small && repeat_paths()) || (very_small && change_steps())) return true;
  return harden(small && !costly ? affordable_guesses() : guesses_of_path, INT_MAX);
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

// What slipped sticks first under other loads, as points of a plastic body are elastic first: slip that would go on may lead to
// another solution than the one that loads lead to on their way, with joints loose that are locked.
bool StateSearch::from(const VectorXd& x, const VectorXd& nu, const VectorXd& reaction, bool solved)
{
  const auto begin = [&](bool sticks) {
    point_.x = x;
    point_.nu = nu;
    states_ = programme_.states_at(x, reaction);
    if (!sticks) return;
    for (auto& kind : states_.kind)
      if (kind == ConstraintStates::Kind::slips) kind = ConstraintStates::Kind::sticks;
  };
  if (!solved) {
    begin(false);
    return from_guessed_states();
  }
  const bool same_loads = programme_.residual(x, nu) <= other_loads * programme_.size(x);
  begin(!same_loads);
  if (guess(look_back_at_first)) return true;
  begin(same_loads);
  return guess(look_back_at_first);
}

// Guesses from states that another way has come to. If the first changes many of them, that way knew nothing.
bool StateSearch::from_guessed_states()
{
  std::vector<int> turns(states_.kind.size(), 0);
  try {
    programme_.solve(states_, point_.x, point_.nu);
    ++point_.steps;
    auto next = programme_.states(point_.x, point_.nu);
    const int changes = compare(states_, next, turns);
    states_ = std::move(next);
    return changes <= nearly_right * static_cast<double>(states_.closed.size() + states_.kind.size()) &&
           guess(look_back_at_first);
  } catch (const Error& error) {
    if (error.status() != ExitStatus::not_converged) throw;
    return false;
  }
}

void StateSearch::polish()
{
  for (int step = 0; step < most_polishing; ++step) {
    const double before = off();
    if (before <= flutter) return;
    const VectorXd x = point_.x, nu = point_.nu;
    programme_.solve(states_, point_.x, point_.nu);
    if (off() <= before) {
      states_ = programme_.states(point_.x, point_.nu);
      continue;
    }
    point_.x = x;
    point_.nu = nu;
    return;
  }
}

// Guesses that fit into `most_operations`, each a factor of W.
int StateSearch::affordable_guesses() const
{
  const auto n = static_cast<double>(programme_.unknowns());
  return static_cast<int>(std::min(most_operations / (2 * n * n * n / 3), 1e4));
}

// Back towards the x and nu before, as long as that makes the residual smaller.
void StateSearch::shorten(const VectorXd& x_before, const VectorXd& nu_before)
{
  const VectorXd x_step = point_.x - x_before, nu_step = point_.nu - nu_before;
  double part = 1, least = programme_.residual(point_.x, point_.nu);
  for (int i = 0; i < halvings; ++i) {
    part /= 2;
    const VectorXd x = x_before + part * x_step, nu = nu_before + part * nu_step;
    const double residual = programme_.residual(x, nu);
    if (!(residual < least)) return;
    least = residual;
    point_.x = x, point_.nu = nu;
  }
}

// Whether motions go on by the same step for ever while forces stay what they are, and friction resists that.
bool StateSearch::is_unbounded(const VectorXd& step, const VectorXd& last_step) const
{
  return last_step.size() == step.size() && (step - last_step).norm() <= same_step * step.norm() &&
         programme_.friction_power(point_.x, step) > 0;
}

// Guesses from `states_` on; false if they do not converge. Those that something else comes after end sooner: if in `look_back`
// of them changes have not become half as many. So do those of bodies that run away: no state changes any more, and each solution
// leads as far from the last one as this from the one before, as weak springs allow. Where no force answers there is no solution
// [Pazy, Israel J. Math. 9 (1971), of monotone problems]. Steps between soft contacts that make the residual larger are
// shortened: where friction passes forces on, whole ones take turns for ever. So they may without softness where few states are
// left to settle: then the last of the places that would change does so alone, which ends where W is a P-matrix [Murty, Linear
// Algebra Appl. 9 (1974)], until there are fewer changes than ever [Judice and Pires, Comput. Oper. Res. 21 (1994)].
bool StateSearch::guess(int look_back)
{
  std::vector<int> turns(states_.kind.size(), 0), history;
  const double few = std::max(few_changes * static_cast<double>(states_.closed.size() + states_.kind.size()), handful);
  int guesses = look_back > 0 || programme_.softness() > 0 ? max_guesses : max_last_guesses;
  const int most = std::min(max_single_guesses, affordable_guesses());
  int fewest = INT_MAX, fewest_at = 0, solutions = 0;
  double before = 0, least = 0;
  VectorXd best_x, best_nu, last_step;
  unbounded_ = false;
  for (int step = 0; step < guesses; ++step) {
    stop_if_requested();
    const VectorXd x_before = point_.x, nu_before = point_.nu;
    programme_.solve(states_, point_.x, point_.nu);
    ++point_.steps;
    double residual = programme_.residual(point_.x, point_.nu);
    if (step > 0 && programme_.softness() > 0 && residual > worse * before) {
      shorten(x_before, nu_before);
      residual = programme_.residual(point_.x, point_.nu);
    }
    const double size = programme_.size(point_.x);
    if (!std::isfinite(residual) && sparing_) return false;
    auto next = programme_.states(point_.x, point_.nu);
    const int changes = compare(states_, next, turns);
    if (changes < fewest) fewest = changes, fewest_at = step;
    const bool single = look_back == to_the_end && programme_.softness() == 0 && changes > 1 && changes <= few &&
                        step - fewest_at >= idle_before_single;
    if (single) programme_.keep_one_change(states_, next);
    if (single && step + 1 == guesses && step - fewest_at < idle_single && guesses < most) ++guesses;
    states_ = std::move(next);
    const bool stands = residual > stalled * before;
    const bool rounded = stands && residual <= roundings * programme_.rounding(point_.x, point_.nu);
    const bool small = residual <= settled_residual * size || (stands && residual <= rounded_residual * size) || rounded;
    // Where no force is left, as of a joint that is loosened, states are rounding, and change for ever.
    solutions += residual <= settled_residual * size ? 1 : 0;
    const bool turns_on_rounding =
        residual <= flutter * size || (rounded && step - fewest_at >= idle) || solutions >= solved_again;
    point_.settled = residual <= flutter * size || (changes == 0 && (rounded || residual <= settled_residual * size));
    if (residual < least || step == 0) {
      least = residual;
      best_x = point_.x, best_nu = point_.nu;
    }
    if (step > 0 && small && (changes == 0 || turns_on_rounding)) {
      if (!point_.settled) point_.x = std::move(best_x), point_.nu = std::move(best_nu);
      return true;
    }
    if (changes == 0 && residual <= settled_residual * size) return true;
    if (programme_.softness() > 0 && changes <= few && residual <= residual_of_soft * size) return true;
    VectorXd nu_step = point_.nu - nu_before;
    if (changes == 0 && !small && is_unbounded(nu_step, last_step)) {
      unbounded_ = true;
      last_step_ = std::move(nu_step);
      return false;
    }
    last_step = std::move(nu_step);
    history.push_back(changes);
    if (look_back > 0 && step >= look_back && changes > few &&
        2 * changes > history[history.size() - 1 - static_cast<std::size_t>(look_back)])
      return false;  // taking turns
    before = residual;
  }
  return false;
}

// Whether bodies have run away in the last guesses and slide along contact without softness, rather than leave it: then there is
// nothing else to look for. What leaves may still be held by forces that are locked in.
bool StateSearch::slides()
{
  point_.slides =
      unbounded_ && programme_.softness() == 0 && programme_.opening(last_step_) <= way_out * programme_.slip(last_step_);
  return point_.slides;
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
  while (static_cast<int>(points.size()) < most_on_path && points.back().product > last * points[0].product && path.advance()) {
    if (is_end()) return true;
    points.push_back(path.distance());
    const auto count = points.size();
    if (count > stuck_on_path && !halved(points.back(), points[count - 1 - stuck_on_path])) break;
  }
  return false;
}

// Guesses from points of the central path that come near.
bool StateSearch::follow_path()
{
  start_soft();
  auto path = programme_.path_from(point_.x, point_.nu);
  const bool costly = sparing_;
  double wanted = costly ? path_nearer * path_near : path_near;
  const bool ended = walk(path, 0, [&] {
    ++point_.steps;
    const double now = programme_.residual(path.x(), path.nu()) / programme_.size(path.x());
    if (!(now <= wanted)) return false;
    wanted = path_nearer * now;
    point_.x = path.x(), point_.nu = path.nu();
    states_ = programme_.states(point_.x, point_.nu);
    return guess(now <= settled_residual ? to_the_end : costly ? look_back_at_first : look_back_on_path);
  });
  if (ended || !costly) return ended;
  point_.x = path.x(), point_.nu = path.nu();
  states_ = programme_.states(point_.x, point_.nu);
  point_.settled = off() <= flutter;
  return off() <= end_of_costly_path;
}

// Coulomb's law by radii that are given, those of the normal forces before: each of these programmes is convex, so its path leads
// to its solution, and where rows depend on each other to the middle of all.
bool StateSearch::repeat_paths()
{
  if (!programme_.follows()) return false;
  const bool costly = sparing_;
  start_soft();
  double best = std::numeric_limits<double>::infinity(), wanted = costly ? worth_a_guess : path_near;
  VectorXd nearest_x, nearest_nu;
  for (int since_best = 0; since_best < (costly ? patience_with_costly_radii : patience_with_radii);) {
    auto path = programme_.path_with_radii(point_.x, point_.nu);
    walk(path, costly ? end_of_rough_path : end_of_path, [&] {
      ++point_.steps;
      return false;
    });
    point_.x = path.x(), point_.nu = path.nu();
    const double now = off();
    if (!std::isfinite(now)) return false;
    states_ = programme_.states(point_.x, point_.nu);
    point_.settled = now <= flutter;
    if (now <= settled_on_path) return true;
    if (now <= wanted) {
      if (guess(look_back_at_first)) return true;
      point_.x = path.x(), point_.nu = path.nu();
      if (!costly) wanted = path_nearer * now;
    }
    since_best = now < nearer * best ? 0 : since_best + 1;
    if (now < best) best = now, nearest_x = point_.x, nearest_nu = point_.nu;
    if (best > rounded_on_path || since_best < in_vain) continue;
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
