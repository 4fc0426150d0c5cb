#include "qp/condensed_newton.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <optional>
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
constexpr Eigen::Index few_unknowns = 2000; // up to which a factor of W takes a moment; beyond, as long as many guesses,
constexpr int guesses_of_path = 100;        // and a path of them as long as so many
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

// Looks for the states of one solution: by guesses from closed contact, and from what leads near it where these take turns.
class Search {
 public:
  Search(const CondensedMatrices& matrices, const Eigen::LLT<MatrixXd>& factor_of_w, const FeasibleSet& set, VectorXd b,
         VectorXd e)
      : programme_(matrices, factor_of_w, set, std::move(b), std::move(e)), states_(programme_.all_closed())
  {
    point_.x = VectorXd::Zero(programme_.unknowns());
    point_.nu = VectorXd::Zero(programme_.motions());
    if (programme_.unknowns() > 0) softest_ = softest * matrices.w.diagonal().cwiseQuotient(matrices.own).maxCoeff();
  }

  // From closed contact that sticks, by whatever leads to a solution.
  bool from_anywhere()
  {
    if (guess(look_back_at_first)) return true;
    if (programme_.unknowns() == 0) return false;
    const bool small = programme_.unknowns() <= few_unknowns;
    return harden(small ? 0 : guesses_of_path) || follow_path() || (small && repeat_paths()) || harden(INT_MAX);
  }
  // From the states at a point near.
  bool from(VectorXd x, VectorXd nu)
  {
    point_.x = std::move(x);
    point_.nu = std::move(nu);
    states_ = programme_.states(point_.x, point_.nu);
    return guess(to_the_end);
  }
  // Steps of GMRES leave what settles states, but not all figures: thin plates bend by 1e8 times what decides about contact.
  void polish()
  {
    const double before = off();
    if (before <= flutter) return;
    const VectorXd x = point_.x, nu = point_.nu;
    programme_.solve(states_, point_.x, point_.nu);
    if (off() <= before) return;
    point_.x = x;
    point_.nu = nu;
  }

  const CondensedNewton::Point& point() const { return point_; }
  VectorXd reaction() const { return programme_.gradient(point_.x, point_.nu); }

 private:
  // The hardest of the soft contacts that have converged.
  struct Soft {
    double softness, stride;  // to the next one
    ConstraintStates states;
    VectorXd nu;
  };

  // The residual over x.
  double off() const { return programme_.residual(point_.x, point_.nu) / programme_.size(point_.x); }
  bool guess(int look_back);
  bool harden(int patience);
  bool follow_path();
  bool repeat_paths();
  void start_soft();
  template <class Visit>
  static bool walk(CentralPath& path, double last, const Visit& is_end);

  CondensedProgramme programme_;
  ConstraintStates states_;
  CondensedNewton::Point point_;
  double softest_ = 0;
  std::optional<Soft> soft_;
};

// Guesses from `states_` on; false if they do not converge. Those that something else comes after end sooner: if in `look_back`
// of them changes have not become half as many.
bool Search::guess(int look_back)
{
  std::vector<int> turns(states_.kind.size(), 0), history;
  const double few = std::max(few_changes * static_cast<double>(states_.closed.size() + states_.kind.size()), handful);
  const int guesses = look_back > 0 || programme_.softness() > 0 ? max_guesses : max_last_guesses;
  int fewest = INT_MAX, fewest_at = 0;
  double before = 0;
  for (int step = 0; step < guesses; ++step) {
    stop_if_requested();
    programme_.solve(states_, point_.x, point_.nu);
    ++point_.steps;
    const double residual = programme_.residual(point_.x, point_.nu), size = programme_.size(point_.x);
    auto next = programme_.states(point_.x, point_.nu);
    const int changes = compare(states_, next, turns);
    states_ = std::move(next);
    if (changes < fewest) fewest = changes, fewest_at = step;
    const bool stands = residual > stalled * before, rounded = stands && residual <= roundings * programme_.rounding(point_.x);
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

// Guesses from a soft contact on, which becomes harder as fast as they converge. Where they do not, it becomes harder slower, for
// as many guesses as `patience` says; the next call goes on from there.
bool Search::harden(int patience)
{
  if (!soft_) {
    states_ = programme_.all_closed();
    point_.nu.setZero();
    programme_.soften(softest_);
    guess(to_the_end);
    soft_ = Soft{softest_, stride, states_, point_.nu};
  }
  auto& [softness, part, states, nu] = *soft_;
  int left = INT_MAX;  // guesses
  while (softness > 0 && left > 0) {
    const double next = softness * part > hardest ? softness * part : 0;
    const int before = point_.steps;
    states_ = states;
    point_.nu = nu;
    programme_.soften(next);
    const bool converged = guess(to_the_end), slowest = part >= least_stride;
    const int taken = point_.steps - before;
    if (!converged) left = std::min(left, patience);
    if (left < INT_MAX) left -= taken;
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
void Search::start_soft()
{
  point_.nu.setZero();
  programme_.soften(softest_);
  programme_.solve(programme_.all_closed(), point_.x, point_.nu);
  programme_.soften(0);
}

// Along a path until `is_end` of a point, its product is `last` over the first, or it leads nowhere. Whether it was the first.
template <class Visit>
bool Search::walk(CentralPath& path, double last, const Visit& is_end)
{
  std::vector<double> products{path.product()};
  while (static_cast<int>(products.size()) < most_on_path && products.back() > last * products[0] && path.advance()) {
    if (is_end()) return true;
    products.push_back(path.product());
    const auto count = products.size();
    if (count > stuck_on_path && 2 * products.back() > products[count - 1 - stuck_on_path]) break;
  }
  return false;
}

// Guesses from points of the central path that come near.
bool Search::follow_path()
{
  start_soft();
  auto path = programme_.path_from(point_.x, point_.nu);
  double wanted = path_near;
  return walk(path, 0, [&] {
    ++point_.steps;
    const double now = programme_.residual(path.x(), path.nu()) / programme_.size(path.x());
    if (!(now <= wanted)) return false;
    wanted = path_nearer * now;
    point_.x = path.x(), point_.nu = path.nu();
    states_ = programme_.states(point_.x, point_.nu);
    return guess(now > settled_residual ? look_back_on_path : to_the_end);
  });
}

// Coulomb's law by radii that are given, those of the normal forces before: each of these programmes is convex, so its path leads
// to its solution, and where rows depend on each other to the middle of all.
bool Search::repeat_paths()
{
  if (!programme_.follows()) return false;
  start_soft();
  double best = std::numeric_limits<double>::infinity();
  for (int since_best = 0; since_best < patience_with_radii;) {
    auto path = programme_.path_with_radii(point_.x, point_.nu);
    walk(path, end_of_path, [&] {
      ++point_.steps;
      return false;
    });
    point_.x = path.x(), point_.nu = path.nu();
    const double now = off();
    if (!std::isfinite(now)) return false;
    if (now <= settled_on_path) {
      states_ = programme_.states(point_.x, point_.nu);
      return true;
    }
    since_best = now < nearer * best ? 0 : since_best + 1;
    best = std::min(best, now);
  }
  return false;
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
  separated_ = separate_dependent_rows();
  if (separated_) measure();
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

CondensedNewton::Point CondensedNewton::solve(const VectorXd& b, const VectorXd& e, const FeasibleSet& set,
                                              const Point* near) const
{
  Search search(matrices_, contact_, set.compact(), b(constrained_) - coupling_.transpose() * b(others_),
                e - motion_.transpose() * b(others_));
  const bool converged = near ? search.from(near->x(constrained_), near->nu) : search.from_anywhere();
  if (converged) search.polish();
  Point point = search.point();
  point.converged = converged;
  const VectorXd contact = point.x;
  point.x.resize(b.size());
  point.x(constrained_) = contact;
  point.x(others_) = free_.solve(VectorXd(b(others_))) - coupling_ * contact - motion_ * point.nu;
  point.reaction = VectorXd::Zero(b.size());
  point.reaction(constrained_) = search.reaction();
  return point;
}

}  // namespace mortise::qp
