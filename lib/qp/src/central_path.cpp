#include "central_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/interruption.hpp"

namespace mortise::qp {

namespace {

constexpr double least_pressed = 3;       // of the mean, at the start: what presses in the end may be few of all points
constexpr double largest_friction = 0.5;  // of the radius, at the start
constexpr double to_border = 0.99;        // of the way
constexpr double predicted = 0.999;       // the same before it is corrected
constexpr double least_product = 1e-3;    // of the mean: what is nearer to the border than to the path is stuck there
constexpr double shorter = 0.8;           // step, where it leads there,
constexpr int most_shorter = 40;          // and so often
constexpr double least_centring = 1e-3;   // tau of the next point over that of this one
constexpr double near_border = 1e-3;      // of a radius
constexpr double most_turned = 0.3;       // of the radius: a point near the border may go across,
constexpr double least_turned = 0.5;      // and so little may be left of its distance from the centre
constexpr double least_turn = 0.01;       // of the room that is left: what is less is not worth its rounding
constexpr double no_step = 1e-8;          // as good as none

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

bool is_near_border(double length, double radius)
{
  return radius - length < near_border * radius;
}

// The part of a step (dt, dr) that a point t stays inside of a disc of radius r for.
double part_inside(const Vector2d& t, const Vector2d& dt, double r, double dr)
{
  constexpr double whole = std::numeric_limits<double>::infinity();
  const double size = t.norm();
  // (t + a dt)^2 = (r + a dr)^2: a, b and c of a quadratic equation whose c is below zero.
  const double a = dt.squaredNorm() - dr * dr, b = t.dot(dt) - r * dr, c = (size - r) * (size + r);
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  const double straight = b > 0 ? -c / (b + root) : a > 0 ? (root - b) / a : whole;
  if (!is_near_border(size, r)) return straight;
  const double out = t.dot(dt) / size - dr, across = std::abs(t[0] * dt[1] - t[1] * dt[0]) / size;
  const double turning = std::min(out > 0 ? (r - size) / out : whole, across > 0 ? most_turned * r / across : whole);
  return std::max(straight, turning);
}

}  // namespace

CentralPath::Residual& CentralPath::Residual::add(double part, const Residual& other)
{
  forces += part * other.forces;
  motions += part * other.motions;
  sides += part * other.sides;
  rounds += part * other.rounds;
  return *this;
}

double CentralPath::Residual::mean() const
{
  return (sides.sum() + rounds.sum()) / static_cast<double>(std::max<Index>(1, sides.size() + rounds.size()));
}

double CentralPath::Residual::least() const
{
  double result = std::numeric_limits<double>::infinity();
  for (const auto* products : {&sides, &rounds})
    if (products->size() > 0) result = std::min(result, products->minCoeff());
  return result;
}

CentralPath::CentralPath(const ContactSystem& system, const FeasibleSet& set, const std::vector<int>& bound_of, VectorXd b,
                         VectorXd e, VectorXd x, VectorXd nu)
    : system_(system), b_(std::move(b)), e_(std::move(e)), at_{std::move(x), std::move(nu), {}, {}}
{
  for (const auto& bound : set.bounds()) sides_.push_back({bound.index, 1, -bound.lower});
  for (std::size_t d = 0; d < set.discs().size(); ++d) add_disc(set.discs()[d], bound_of[d] >= 0);
  move_inside(set);
}

void CentralPath::add_disc(const Disc& disc, bool follows)
{
  if (!follows && !(disc.radius > 0)) {
    for (int k = 0; k < disc.size(); ++k) {
      const Local i = disc.index[static_cast<std::size_t>(k)];
      pinned_.push_back(i);
      at_.x[i] = disc.centre[static_cast<std::size_t>(k)];
    }
  } else if (follows || std::isfinite(disc.radius)) {
    const double coefficient = follows ? disc.coefficient : 0;
    if (disc.size() == 2) rounds_.push_back({disc, coefficient});
    if (disc.size() == 2) return;
    for (const double sign : {1.0, -1.0})
      sides_.push_back({disc.index[0], sign, (follows ? 0 : disc.radius) - sign * disc.centre[0], coefficient, disc.normal});
  }
}

double CentralPath::radius(const Round& round, const VectorXd& x) const
{
  return round.coefficient > 0 ? round.coefficient * x[round.disc.normal] : round.disc.radius;
}

// From where it was given, and all products alike there.
void CentralPath::move_inside(const FeasibleSet& set)
{
  auto& x = at_.x;
  const auto bounds = set.bounds();
  double pressed = 0;
  for (const auto& bound : bounds) pressed += std::abs(x[bound.index] - bound.lower);
  if (!bounds.empty()) pressed *= least_pressed / static_cast<double>(bounds.size());
  for (const auto& bound : bounds) x[bound.index] = std::max(x[bound.index], bound.lower + pressed);
  for (const auto& disc : set.discs()) {
    const bool follows = disc.coefficient > 0 && disc.normal >= 0;
    const double most = largest_friction * (follows ? disc.coefficient * x[disc.normal] : disc.radius);
    const Vector2d t = from_centre(disc, x);
    if (const double length = t.norm(); length > most)
      for (int k = 0; k < disc.size(); ++k) x[disc.index[static_cast<std::size_t>(k)]] += (most / length - 1) * t[k];
  }
  const VectorXd gradient = system_.give(x) + system_.push(at_.nu) - b_;
  at_.s = VectorXd::Ones(static_cast<Index>(sides_.size()));
  at_.lambda = VectorXd::Ones(static_cast<Index>(rounds_.size()));
  const Residual room = residual(at_);  // distances from the borders
  double tau = 0;
  for (std::size_t i = 0; i < sides_.size(); ++i) tau += room.sides[static_cast<Index>(i)] * std::abs(gradient[sides_[i].along]);
  for (std::size_t d = 0; d < rounds_.size(); ++d)
    tau += room.rounds[static_cast<Index>(d)] * from_centre({rounds_[d].disc.index}, gradient).norm();
  tau /= static_cast<double>(std::max<std::size_t>(1, sides_.size() + rounds_.size()));
  at_.s = tau * room.sides.cwiseInverse();
  at_.lambda = tau * room.rounds.cwiseInverse();
}

// What the equations lack, and the products that are to be tau.
CentralPath::Residual CentralPath::residual(const Iterate& at) const
{
  const auto& [x, nu, s, lambda] = at;
  Residual result{system_.give(x) + system_.push(nu) - b_, system_.excess(x, nu, e_), VectorXd(s.size()),
                  VectorXd(lambda.size())};
  for (Index i = 0; i < s.size(); ++i) {
    const auto& side = sides_[static_cast<std::size_t>(i)];
    result.forces[side.along] -= side.sign * s[i];
    result.sides[i] = side.room(x) * s[i];
  }
  for (Index d = 0; d < lambda.size(); ++d) {
    const auto& round = rounds_[static_cast<std::size_t>(d)];
    const double r = radius(round, x);
    const Vector2d t = from_centre(round.disc, x);
    for (int k = 0; k < round.disc.size(); ++k)
      result.forces[round.disc.index[static_cast<std::size_t>(k)]] += lambda[d] * t[k] / r;
    result.rounds[d] = lambda[d] * (r - t.norm()) * (r + t.norm()) / (2 * r);
  }
  for (const Local i : pinned_) result.forces[i] = 0;
  return result;
}

// The part of a step that meets the first border.
double CentralPath::longest_step(const Iterate& step) const
{
  double length = 1;
  const auto stop = [&](double value, double change) {
    if (change < 0) length = std::min(length, -value / change);
  };
  for (Index i = 0; i < at_.s.size(); ++i) {
    const auto& side = sides_[static_cast<std::size_t>(i)];
    stop(side.room(at_.x), side.change(step.x));
    stop(at_.s[i], step.s[i]);
  }
  for (Index d = 0; d < at_.lambda.size(); ++d) {
    const auto& round = rounds_[static_cast<std::size_t>(d)];
    stop(at_.lambda[d], step.lambda[d]);
    const Vector2d t = from_centre(round.disc, at_.x), dt = from_centre({round.disc.index}, step.x);
    const double r = radius(round, at_.x), dr = round.coefficient > 0 ? round.coefficient * step.x[round.disc.normal] : 0;
    length = std::min(length, part_inside(t, dt, r, dr));
  }
  return length;
}

// A point near the border of its disc turns round the centre: along the chord it would meet the border the sooner the nearer it
// is.
CentralPath::Iterate CentralPath::moved(const Iterate& step, double length) const
{
  Iterate next{at_.x + length * step.x, at_.nu + length * step.nu, at_.s + length * step.s, at_.lambda + length * step.lambda};
  for (const auto& round : rounds_) {
    const Vector2d t = from_centre(round.disc, at_.x), there = from_centre(round.disc, next.x);
    const double before = t.norm(), after = there.norm(), wanted = t.dot(there) / before;
    if (!is_near_border(before, radius(round, at_.x)) || wanted < least_turned * before) continue;
    if (after - wanted < least_turn * (radius(round, next.x) - wanted)) continue;
    for (int k = 0; k < round.disc.size(); ++k)
      next.x[round.disc.index[static_cast<std::size_t>(k)]] += (wanted / after - 1) * there[k];
  }
  return next;
}

// The equations at a point made linear, s and lambda eliminated.
class CentralPath::Linear {
 public:
  explicit Linear(const CentralPath& path) : path_(path)
  {
    const auto entries = make_entries();
    factor_ = path.system_.factor(entries, path.pinned_, path.symmetric());
  }

  /// The step that makes up for `lack`.
  Iterate solve(const Residual& lack, bool roughly) const
  {
    const auto& [x, nu, s, lambda] = path_.at_;
    VectorXd right = -lack.forces;
    for (Index i = 0; i < s.size(); ++i) {
      const auto& side = path_.sides_[static_cast<std::size_t>(i)];
      right[side.along] -= side.sign * lack.sides[i] / side.room(x);
    }
    for (Index d = 0; d < lambda.size(); ++d) {
      const auto& part = parts_[static_cast<std::size_t>(d)];
      const auto& disc = path_.rounds_[static_cast<std::size_t>(d)].disc;
      for (int k = 0; k < disc.size(); ++k)
        right[disc.index[static_cast<std::size_t>(k)]] += lack.rounds[d] / part.room * part.towards[k];
    }
    for (const Local i : path_.pinned_) right[i] = 0;
    auto found = factor_->solve(right, lack.motions, roughly);
    Iterate step{std::move(found.x), std::move(found.nu), VectorXd(s.size()), VectorXd(lambda.size())};
    for (Index i = 0; i < s.size(); ++i) {
      const auto& side = path_.sides_[static_cast<std::size_t>(i)];
      step.s[i] = -(lack.sides[i] + s[i] * side.change(step.x)) / side.room(x);
    }
    for (Index d = 0; d < lambda.size(); ++d) {
      const auto& part = parts_[static_cast<std::size_t>(d)];
      const auto& round = path_.rounds_[static_cast<std::size_t>(d)];
      const double wider = round.coefficient > 0 ? round.coefficient * step.x[round.disc.normal] : 0;
      const double nearer = part.towards.dot(from_centre({round.disc.index}, step.x));
      step.lambda[d] = -(lack.rounds[d] + lambda[d] * (part.widening * wider - nearer)) / part.room;
    }
    return step;
  }

 private:
  struct Part {  // of a disc: t / r, (r^2 - t't) / (2 r), and what this gains as r does
    Vector2d towards;
    double room, widening;
  };

  std::vector<Stiffening> make_entries()
  {
    const auto& [x, nu, s, lambda] = path_.at_;
    std::vector<Stiffening> entries;
    for (Index i = 0; i < s.size(); ++i) {
      const auto& side = path_.sides_[static_cast<std::size_t>(i)];
      const double stiffness = s[i] / side.room(x);
      entries.push_back({side.along, side.along, stiffness});
      if (side.coefficient > 0) entries.push_back({side.along, side.normal, side.sign * side.coefficient * stiffness});
    }
    for (Index d = 0; d < lambda.size(); ++d) {
      const auto& round = path_.rounds_[static_cast<std::size_t>(d)];
      const Vector2d t = from_centre(round.disc, x);
      const double r = path_.radius(round, x);
      const Part part{t / r, (r - t.norm()) * (r + t.norm()) / (2 * r), (1 + t.squaredNorm() / (r * r)) / 2};
      parts_.push_back(part);
      for (int k = 0; k < round.disc.size(); ++k) {
        const Local row = round.disc.index[static_cast<std::size_t>(k)];
        entries.push_back({row, row, lambda[d] / r});
        for (int l = 0; l < round.disc.size(); ++l)
          entries.push_back(
              {row, round.disc.index[static_cast<std::size_t>(l)], lambda[d] / part.room * part.towards[k] * part.towards[l]});
        if (round.coefficient > 0)
          entries.push_back(
              {row, round.disc.normal, -(round.coefficient * lambda[d] * (part.widening / part.room + 1 / r) * part.towards[k])});
      }
    }
    return entries;
  }

  const CentralPath& path_;
  std::vector<Part> parts_;
  std::unique_ptr<PathFactor> factor_;
};

bool CentralPath::symmetric() const
{
  const auto follows = [](const auto& constraint) { return constraint.coefficient > 0; };
  return std::none_of(sides_.begin(), sides_.end(), follows) && std::none_of(rounds_.begin(), rounds_.end(), follows);
}

bool CentralPath::advance()
{
  stop_if_requested();
  const Residual now = residual(at_);
  const double tau = now.mean();
  if (!(tau > 0) || !std::isfinite(tau)) return false;
  const Linear linear(*this);
  // Where tau = 0 would lead to tells how much of it can go at once, and what else the equations are than linear.
  const Iterate prediction = linear.solve(now, true);
  if (!prediction.x.allFinite() || !prediction.nu.allFinite()) return false;
  const double reach = predicted * longest_step(prediction);
  Residual goal = residual(moved(prediction, reach));
  const double centring = std::max(std::pow(std::max(goal.mean(), 0.0) / tau, 3), least_centring);
  goal.add(reach, now);        // what the step leaves, and would not leave of linear equations
  goal.motions = now.motions;  // these are linear: what the prediction leaves of them is its error
  goal.sides.array() -= centring * tau;
  goal.rounds.array() -= centring * tau;
  const Iterate step = linear.solve(goal, false);
  if (!step.x.allFinite() || !step.nu.allFinite()) return false;
  double length = std::min(1.0, to_border * longest_step(step));
  Iterate next = moved(step, length);
  for (int i = 0; i < most_shorter; ++i) {
    const Residual there = residual(next);
    if (there.least() > least_product * there.mean()) break;
    length *= shorter;
    next = moved(step, length);
  }
  at_ = std::move(next);
  return length > no_step;
}

CentralPath::Distance CentralPath::distance() const
{
  const Residual now = residual(at_);
  return {now.mean(), now.forces.norm(), now.motions.norm()};
}

}  // namespace mortise::qp
