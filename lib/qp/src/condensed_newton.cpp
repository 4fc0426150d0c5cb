#include "qp/condensed_newton.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <utility>

#include "central_path.hpp"
#include "condensed_programme.hpp"

namespace mortise::qp {

namespace {

constexpr int max_guesses = 15;        // at one softness, and so many
constexpr int max_last_guesses = 60;   // once it is none: forces that hardly count settle late;
constexpr int look_back_at_first = 4;  // guesses that must have halved changes, if these are more than so few
constexpr int look_back_on_path = 1;
constexpr int to_the_end = 0;
constexpr double few_changes = 0.02;        // of all constraints, or so few,
constexpr double handful = 8;               // or so few in all
constexpr double dependent = 1e-10;         // of what a row gives way with all others: less alone comes of rounding
constexpr double apart = 1e-8;              // compliance of its own that such a row is given, over that
constexpr int max_turns = 3;                // of the slip at a point; then it sticks before it turns
constexpr double settled_residual = 1e-10;  // residual over x
constexpr double flutter = 1e-12;           // the same below which guesses differ by rounding
constexpr double stalled = 0.5;             // of the residual before: what rounding has left of it,
constexpr double rounded_residual = 1e-6;   // over x, which is no more than this, or than so many times
constexpr double roundings = 1e4;           // what rounding makes of W x,
constexpr int idle = 8;                     // and so many guesses have not brought fewer changes
constexpr double softest = 0.1;             // of what a point gives way together with all others
constexpr double hardest = 1e-4;            // softness that is as good as none
constexpr double stride = 0.1;              // from one softness to the next
constexpr double least_stride = 0.8;        // as slow as it gets,
constexpr double largest_stride = 1e-4;     // and as fast, where
constexpr int at_once = 2;                  // guesses were enough
constexpr int most_on_path = 100;           // linear problems along the central path,
constexpr int stuck_on_path = 12;           // the last of so many must have brought it half as near as it was
constexpr double path_near = 1e-3;          // residual over x from which on guesses are tried from the path,
constexpr double path_nearer = 0.1;         // and of what it was then, to try again
constexpr int most_repeated = 2000;         // unknowns: more take minutes
constexpr int patience_with_radii = 6;      // radii in a row without a residual that is so much
constexpr double nearer = 0.7;              // of the least before
constexpr double end_of_path = 1e-13;       // of the first product
constexpr double settled_on_path = 1e-9;    // residual over x at which radii are those of the forces

using Eigen::MatrixXd;
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

// That of W^-1 = L^-T L^-1: the squares of the columns of L^-1, which are zero above the diagonal.
VectorXd diagonal_of_inverse(const Eigen::LLT<MatrixXd>& factor)
{
  const auto& l = factor.matrixLLT();
  VectorXd result(l.rows());
  in_pieces(l.rows(), [&](Eigen::Index first, Eigen::Index count) {
    const Eigen::Index rest = l.rows() - first;
    MatrixXd columns = MatrixXd::Identity(rest, count);
    l.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>().solveInPlace(columns);
    result.segment(first, count) = columns.colwise().squaredNorm();
  });
  return result;
}

}  // namespace

CondensedNewton::CondensedNewton(MatrixXd a, MatrixXd g, MatrixXd c, const FeasibleSet& set) : constrained_(set.constrained())
{
  std::vector<char> taken(static_cast<std::size_t>(a.rows()), 0);
  for (const Local i : constrained_) taken[static_cast<std::size_t>(i)] = 1;
  for (Local i = 0; i < static_cast<Local>(a.rows()); ++i)
    if (!taken[static_cast<std::size_t>(i)]) others_.push_back(i);
  const MatrixXd between = a(others_, constrained_), g_free = g(Eigen::all, others_);
  free_ = factorize(a(others_, others_));
  coupling_ = qp::solve(free_, between);
  motion_ = qp::solve(free_, g_free.transpose());
  matrices_.w = a(constrained_, constrained_);
  in_pieces(matrices_.w.cols(), [&](Eigen::Index first, Eigen::Index count) {
    matrices_.w.middleCols(first, count).noalias() -= between.transpose() * coupling_.middleCols(first, count);
  });
  matrices_.w = 0.5 * (matrices_.w + matrices_.w.transpose()).eval();
  matrices_.h = g(Eigen::all, constrained_) - g_free * coupling_;
  matrices_.c = std::move(c);
  matrices_.c.noalias() += g_free * motion_;
  measure();
  if (separate_dependent_rows()) measure();
}

// What each point gives way alone.
void CondensedNewton::measure()
{
  contact_ = factorize(matrices_.w);
  matrices_.own = diagonal_of_inverse(contact_).cwiseInverse();
}

// Rows that depend on each other, as those of two contacts along the edge that a body has in a corner: how a force is shared out
// between them is open, and rounding alone would tell their states. A little compliance of their own shares it out evenly.
// Returns whether there are any.
bool CondensedNewton::separate_dependent_rows()
{
  auto diagonal = matrices_.w.diagonal();
  bool any = false;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (matrices_.own[i] > dependent * diagonal[i]) continue;
    diagonal[i] *= 1 + apart;
    any = true;
  }
  return any;
}

VectorXd CondensedNewton::inverse_times(const VectorXd& r) const
{
  VectorXd x(r.size());
  const VectorXd contact = contact_.solve(VectorXd(r(constrained_) - coupling_.transpose() * r(others_)));
  x(constrained_) = contact;
  x(others_) = free_.solve(VectorXd(r(others_))) - coupling_ * contact;
  return x;
}

// Guesses from `states` on; false if they do not converge. Those that something else comes after end sooner: if in `look_back` of
// them changes have not become half as many.
bool CondensedNewton::iterate(CondensedProgramme& programme, ConstraintStates& states, Point& point, int look_back)
{
  std::vector<int> turns(states.kind.size(), 0), history;
  const double few = std::max(few_changes * static_cast<double>(states.closed.size() + states.kind.size()), handful);
  const int guesses = look_back > 0 || programme.softness() > 0 ? max_guesses : max_last_guesses;
  int fewest = INT_MAX, fewest_at = 0;
  double before = 0;
  for (int step = 0; step < guesses; ++step) {
    stop_if_requested();
    programme.solve(states, point.x, point.nu);
    ++point.steps;
    const double residual = programme.residual(point.x, point.nu), size = programme.size(point.x);
    auto next = programme.states(point.x, point.nu);
    const int changes = compare(states, next, turns);
    states = std::move(next);
    if (changes < fewest) fewest = changes, fewest_at = step;
    const bool stands = residual > stalled * before, rounded = stands && residual <= roundings * programme.rounding(point.x);
    const bool small = residual <= settled_residual * size || (stands && residual <= rounded_residual * size) || rounded;
    // Where no force is left, as of a joint that is loosened, states are rounding, and change for ever.
    const bool turns_on_rounding = residual <= flutter * size || (rounded && step - fewest_at >= idle);
    if (step > 0 && small && (changes == 0 || turns_on_rounding)) return true;
    if (changes == 0 && residual <= settled_residual * size) return true;
    history.push_back(changes);
    if (look_back > 0 && step >= look_back && changes > few &&
        2 * changes > history[history.size() - 1 - static_cast<std::size_t>(look_back)])
      return false;  // taking turns
    before = residual;
  }
  return false;
}

// The same from a soft contact on, which becomes harder as fast as guesses converge. If it is a `trial`, until they do not.
bool CondensedNewton::harden(CondensedProgramme& programme, double softness, ConstraintStates& states, Point& point, bool trial)
{
  double part = stride;
  states = programme.all_closed();
  point.nu.setZero();
  programme.soften(softness);
  iterate(programme, states, point, to_the_end);
  while (softness > 0) {
    const double next = softness * part > hardest ? softness * part : 0;
    auto guess = states;
    const VectorXd nu = point.nu;
    const int steps = point.steps;
    programme.soften(next);
    if (iterate(programme, guess, point, to_the_end)) {
      part = std::max(point.steps - steps <= at_once ? largest_stride : stride, part * part);
    } else if (trial) {
      return false;
    } else if (part < least_stride) {
      part = std::sqrt(part);
      point.nu = nu;
      continue;
    } else if (next == 0) {
      return false;
    }
    states = std::move(guess);
    softness = next;
  }
  return true;
}

// The same from points of the central path, which begins at a soft contact that is closed.
bool CondensedNewton::follow_path(CondensedProgramme& programme, double softness, ConstraintStates& states, Point& point)
{
  point.nu.setZero();
  programme.soften(softness);
  programme.solve(programme.all_closed(), point.x, point.nu);
  programme.soften(0);
  auto path = programme.path_from(point.x, point.nu);
  std::vector<double> products;
  double wanted = path_near;
  while (static_cast<int>(products.size()) < most_on_path && path.advance()) {
    ++point.steps;
    const auto off = [&] { return programme.residual(path.x(), path.nu()) / programme.size(path.x()); };
    if (const double now = off(); now <= wanted) {
      wanted = path_nearer * now;
      point.x = path.x(), point.nu = path.nu();
      states = programme.states(point.x, point.nu);
      if (iterate(programme, states, point, now > settled_residual ? look_back_on_path : to_the_end)) return true;
    }
    products.push_back(path.product());
    const auto count = products.size();
    if (count > stuck_on_path && 2 * products.back() > products[count - 1 - stuck_on_path]) break;
  }
  return false;
}

// Coulomb's law by radii that are given, those of the normal forces before: each of these programmes is convex, so its path leads
// to its solution, and where rows depend on each other to the middle of all.
bool CondensedNewton::repeat_paths(CondensedProgramme& programme, double softness, ConstraintStates& states, Point& point)
{
  if (!programme.follows() || programme.unknowns() > most_repeated) return false;
  point.nu.setZero();
  programme.soften(softness);
  programme.solve(programme.all_closed(), point.x, point.nu);
  programme.soften(0);
  double best = std::numeric_limits<double>::infinity();
  for (int since_best = 0; since_best < patience_with_radii;) {
    auto path = programme.path_with_radii(point.x, point.nu);
    std::vector<double> products{path.product()};
    while (static_cast<int>(products.size()) < most_on_path && products.back() > end_of_path * products[0] && path.advance()) {
      ++point.steps;
      products.push_back(path.product());
      const auto count = products.size();
      if (count > stuck_on_path && 2 * products.back() > products[count - 1 - stuck_on_path]) break;
    }
    point.x = path.x(), point.nu = path.nu();
    const double now = programme.residual(point.x, point.nu) / programme.size(point.x);
    if (!std::isfinite(now)) return false;
    if (now <= settled_on_path) {
      states = programme.states(point.x, point.nu);
      return true;
    }
    since_best = now < nearer * best ? 0 : since_best + 1;
    best = std::min(best, now);
  }
  return false;
}

CondensedNewton::Point CondensedNewton::solve(const VectorXd& b, const VectorXd& e, const FeasibleSet& set) const
{
  CondensedProgramme programme(matrices_, contact_, set.compact(), b(constrained_) - coupling_.transpose() * b(others_),
                               e - motion_.transpose() * b(others_));
  Point point;
  point.x = VectorXd::Zero(programme.unknowns());
  point.nu = VectorXd::Zero(programme.motions());
  auto states = programme.all_closed();
  point.converged = iterate(programme, states, point, look_back_at_first);
  if (!point.converged && programme.unknowns() > 0) {
    const double softness = softest * matrices_.w.diagonal().cwiseQuotient(matrices_.own).maxCoeff();
    point.converged = harden(programme, softness, states, point, true) || follow_path(programme, softness, states, point) ||
                      repeat_paths(programme, softness, states, point) || harden(programme, softness, states, point, false);
  }
  // Steps of GMRES leave what settles states, but not all figures: thin plates bend by 1e8 times what decides about contact.
  if (point.converged && programme.residual(point.x, point.nu) > flutter * programme.size(point.x))
    programme.solve(states, point.x, point.nu);
  VectorXd x(b.size());
  x(constrained_) = point.x;
  x(others_) = free_.solve(VectorXd(b(others_))) - coupling_ * point.x - motion_ * point.nu;
  point.x = std::move(x);
  return point;
}

}  // namespace mortise::qp
