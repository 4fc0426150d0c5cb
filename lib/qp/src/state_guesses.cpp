// Guesses at the states of constraints, one after the other.
#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/interruption.hpp"
#include "state_search.hpp"

namespace mortise::qp {

namespace {

constexpr int max_turns = 3;  // of the slip at a point; then it sticks before it turns
constexpr double worse = 3;   // times the residual before: such a step is shortened,
constexpr int halvings = 6;   // so often at most
constexpr double infinite = std::numeric_limits<double>::infinity();

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

// Whether `look_back` guesses have not made the last number of changes half as large.
bool takes_turns(const std::vector<int>& changes, int look_back)
{
  const auto back = static_cast<std::size_t>(look_back);
  return changes.size() > back && 2 * changes.back() > changes[changes.size() - 1 - back];
}

}  // namespace

// What slipped sticks first under other loads, as points of a plastic body are elastic first: slip that would go on may lead to
// another solution than the one that loads lead to on their way, with joints loose that are locked.
bool StateSearch::from(const VectorXd& x, const VectorXd& nu, const VectorXd& reaction, bool solved)
{
  const Before before{x, nu, reaction};
  if (!solved) {
    begin_from(before, false);
    return from_guessed_states();
  }
  const bool same_loads = programme_.residual(x, nu) <= Limits::other_loads * programme_.size(x);
  begin_from(before, !same_loads);
  if (guess(Limits::look_back_at_first)) return true;
  if (!same_loads && programme_.follows() && follow_loads(before)) return true;
  begin_from(before, same_loads);
  return guess(Limits::look_back_at_first);
}

void StateSearch::begin_from(const Before& before, bool sticks)
{
  point_.x = before.x;
  point_.nu = before.nu;
  states_ = programme_.states_at(before.x, before.reaction);
  if (!sticks) return;
  for (auto& kind : states_.kind)
    if (kind == ConstraintStates::Kind::slips) kind = ConstraintStates::Kind::sticks;
}

// From the loads that `before` is a solution for to those that are asked for, by steps that become shorter where guesses do not
// converge. Coulomb's law may have several solutions: the wedge that is driven in and no longer pushed may sit or be out. Loads
// on their way lead to the first. Slip before is where these loads find the points, and none of theirs.
bool StateSearch::follow_loads(Before before)
{
  for (const auto& disc : programme_.set().discs())
    for (int k = 0; k < disc.size(); ++k) before.reaction[disc.index[static_cast<std::size_t>(k)]] = 0;
  const auto last = programme_.loads(), first = programme_.loads_of(before.x, before.nu, before.reaction);
  double done = 0, stride = 0.5;
  for (int tries = 0; done < 1 && tries < Limits::most_load_steps && stride >= Limits::least_load_step; ++tries) {
    stride = std::min(stride, 1 - done);
    const double part = done + stride;
    programme_.set_loads({(1 - part) * first.b + part * last.b, (1 - part) * first.e + part * last.e});
    begin_from(before, done == 0);
    if (!guess(sparing_ ? Limits::look_back_at_first : to_the_end)) {
      stride /= 2;
      continue;
    }
    before = {point_.x, point_.nu, programme_.gradient(point_.x, point_.nu)};
    done = part;
    stride *= 2;
  }
  programme_.set_loads(last);
  return done == 1;
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
    return changes <= Limits::nearly_right * static_cast<double>(states_.closed.size() + states_.kind.size()) &&
           guess(Limits::look_back_at_first);
  } catch (const Error& error) {
    if (error.status() != ExitStatus::not_converged) throw;
    return false;
  }
}

// Guesses from `states_` on; false if they do not converge. Those that something else comes after end sooner: if in `look_back`
// of them changes have not become half as many, or if the first makes more than `most_changes`. So do those of bodies that run
// away: no state changes any more, and each solution leads as far from the last one as this from the one before, as weak springs
// allow. Where no force answers there is no solution [Pazy, Israel J. Math. 9 (1971), of monotone problems]. Steps between soft
// contacts that make the residual larger are shortened: where friction passes forces on, whole ones take turns for ever. So they
// may without softness where few states are left to settle: then the last of the places that would change does so alone, which
// ends where W is a P-matrix [Murty, Linear Algebra Appl. 9 (1974)], until there are fewer changes than ever [Judice and Pires,
// Comput. Oper. Res. 21 (1994)].
bool StateSearch::guess(int look_back, int most_changes)
{
  std::vector<int> turns(states_.kind.size(), 0), history;
  const double few =
      std::max(Limits::few_changes * static_cast<double>(states_.closed.size() + states_.kind.size()), Limits::handful);
  int guesses = look_back > 0 || programme_.softness() > 0 ? Limits::most_guesses : Limits::most_last_guesses;
  const int most = std::min(Limits::most_single_guesses, affordable_guesses());
  int fewest = INT_MAX, fewest_at = 0, solutions = 0;
  double before = 0, least = 0;
  VectorXd best_x, best_nu, last_step;
  unbounded_ = false;
  first_changes_ = INT_MAX;
  for (int step = 0; step < guesses; ++step) {
    stop_if_requested();
    const VectorXd nu_before = point_.nu;
    const double residual = solve_for_states(step > 0 && programme_.softness() > 0 ? worse * before : infinite);
    const double size = programme_.size(point_.x);
    if (!std::isfinite(residual) && sparing_) return false;
    auto next = programme_.states(point_.x, point_.nu);
    const int changes = compare(states_, next, turns);
    if (changes < fewest) fewest = changes, fewest_at = step;
    const bool single = look_back == to_the_end && programme_.softness() == 0 && changes > 1 && changes <= few &&
                        step - fewest_at >= Limits::idle_before_single;
    if (single) programme_.keep_one_change(states_, next);
    if (single && step + 1 == guesses && step - fewest_at < Limits::idle_single && guesses < most) ++guesses;
    states_ = std::move(next);
    const bool stands = residual > Limits::stalled * before;
    const bool rounded = stands && residual <= Limits::roundings * programme_.rounding(point_.x, point_.nu);
    const bool small = residual <= Limits::settled * size || (stands && residual <= Limits::rounded_residual * size) || rounded;
    // Where no force is left, as of a joint that is loosened, states are rounding, and change for ever.
    solutions += residual <= Limits::settled * size ? 1 : 0;
    const bool turns_on_rounding =
        residual <= Limits::flutter * size || (rounded && step - fewest_at >= Limits::idle) || solutions >= Limits::solved_again;
    point_.settled = residual <= Limits::flutter * size || (changes == 0 && (rounded || residual <= Limits::settled * size));
    if (residual < least || step == 0) {
      least = residual;
      best_x = point_.x, best_nu = point_.nu;
    }
    if (step > 0 && small && (changes == 0 || turns_on_rounding)) {
      if (point_.settled) return true;
      // Of a solution that runs away rounding excuses anything.
      point_.x = std::move(best_x), point_.nu = std::move(best_nu);
      return off() <= Limits::rounded_residual || least <= Limits::roundings * programme_.rounding(point_.x, point_.nu);
    }
    if (changes == 0 && residual <= Limits::settled * size) return true;
    if (programme_.softness() > 0 && changes <= few && residual <= Limits::residual_of_soft * size) return true;
    VectorXd nu_step = point_.nu - nu_before;
    if (changes == 0 && !small && is_unbounded(nu_step, last_step)) {
      unbounded_ = true;
      last_step_ = std::move(nu_step);
      return false;
    }
    last_step = std::move(nu_step);
    history.push_back(changes);
    if (step == 0) first_changes_ = changes;
    if (changes > few && first_changes_ > most_changes) return false;
    if (look_back > 0 && changes > few && takes_turns(history, look_back)) return false;
    before = residual;
  }
  return false;
}

// To the point of these states; part of the way if the residual is above `most` there. The residual.
double StateSearch::solve_for_states(double most)
{
  const VectorXd x_before = point_.x, nu_before = point_.nu;
  programme_.solve(states_, point_.x, point_.nu);
  ++point_.steps;
  const double residual = programme_.residual(point_.x, point_.nu);
  if (!(residual > most)) return residual;
  shorten(x_before, nu_before);
  return programme_.residual(point_.x, point_.nu);
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
  return last_step.size() == step.size() && (step - last_step).norm() <= Limits::same_step * step.norm() &&
         programme_.friction_power(point_.x, step) > 0;
}

// Whether bodies have run away in the last guesses and slide along contact without softness, rather than leave it: then there is
// nothing else to look for. What leaves may still be held by forces that are locked in.
bool StateSearch::slides()
{
  point_.slides =
      unbounded_ && programme_.softness() == 0 && programme_.opening(last_step_) <= Limits::way_out * programme_.slip(last_step_);
  return point_.slides;
}

void StateSearch::polish()
{
  for (int step = 0; step < Limits::most_polishing; ++step) {
    const double before = off();
    if (before <= Limits::flutter) return;
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

}  // namespace mortise::qp
