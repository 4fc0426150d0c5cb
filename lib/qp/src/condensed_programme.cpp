#include "condensed_programme.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dense_system.hpp"

namespace mortise::qp {

namespace {

constexpr double tiny_radius = 1e-12;  // of a disc, over the distance from its centre

using Eigen::Vector2d;
using Eigen::VectorXd;

}  // namespace

CondensedProgramme::CondensedProgramme(const CondensedMatrices& matrices, const Eigen::LLT<Eigen::MatrixXd>& factor_of_w,
                                       FeasibleSet set, VectorXd b, VectorXd e)
    : CondensedProgramme(std::make_unique<DenseSystem>(matrices, factor_of_w, set), set, std::move(b), std::move(e))
{
}

CondensedProgramme::CondensedProgramme(std::unique_ptr<ContactSystem> system, FeasibleSet set, VectorXd b, VectorXd e)
    : system_(std::move(system)),
      set_(std::move(set)),
      loads_{std::move(b), std::move(e)},
      own_(shared_by_discs(system_->own(), set_))
{
  std::vector<int> bound_at(static_cast<std::size_t>(unknowns()), -1);
  const auto bounds = set_.bounds();
  for (std::size_t i = 0; i < bounds.size(); ++i) bound_at[static_cast<std::size_t>(bounds[i].index)] = static_cast<int>(i);
  for (const auto& disc : set_.discs()) {
    const bool follows = disc.coefficient > 0 && disc.normal >= 0;
    bound_of_.push_back(follows ? bound_at[static_cast<std::size_t>(disc.normal)] : -1);
  }
  soften(0);
}

void CondensedProgramme::soften(double softness, double scale)
{
  softness_ = softness;
  softening_ = softness * own_;
  step_ = scale * (own_ * (1 + softness)).cwiseInverse();
}

CondensedProgramme::Loads CondensedProgramme::loads_of(const VectorXd& x, const VectorXd& nu, const VectorXd& reaction) const
{
  return {system_->give(x) + system_->push(nu) - reaction, system_->excess(x, nu, VectorXd::Zero(motions()))};
}

VectorXd CondensedProgramme::gradient(const VectorXd& x, const VectorXd& nu) const
{
  return system_->give(x) + softness_ * own_.cwiseProduct(x) + system_->push(nu) - loads_.b;
}

ConstraintStates CondensedProgramme::all_closed() const
{
  ConstraintStates all;
  all.closed.assign(set_.bounds().size(), 1);
  all.kind.assign(set_.discs().size(), ConstraintStates::Kind::sticks);
  all.slip.resize(set_.discs().size());
  return all;
}

ConstraintStates CondensedProgramme::states_at(const VectorXd& x, const VectorXd& gradient) const
{
  const VectorXd y = x - step_.cwiseProduct(gradient);
  const auto discs = set_.discs();
  ConstraintStates result = all_closed();
  for (std::size_t i = 0; i < result.closed.size(); ++i) {
    const auto& bound = set_.bounds()[i];
    result.closed[i] = y[bound.index] > bound.lower;
  }
  for (std::size_t d = 0; d < discs.size(); ++d) {
    const auto& disc = discs[d];
    const int bound = bound_of_[d];
    if (bound >= 0 && !result.closed[static_cast<std::size_t>(bound)]) {
      result.kind[d] = ConstraintStates::Kind::gone;
      continue;
    }
    auto& slip = result.slip[d];
    const Vector2d w = from_centre(disc, y);
    const double length = w.norm();
    slip.radius = bound >= 0 ? disc.coefficient * y[disc.normal] : disc.radius;
    if (length <= slip.radius) continue;
    result.kind[d] = ConstraintStates::Kind::slips;
    slip.direction = w / length;
    slip.curvature = slip.radius > tiny_radius * length ? (length - slip.radius) / (step_[disc.index[0]] * slip.radius)
                                                        : std::numeric_limits<double>::infinity();
  }
  return result;
}

void CondensedProgramme::keep_one_change(const ConstraintStates& before, ConstraintStates& now) const
{
  const std::size_t bounds = now.closed.size();
  const auto place = [&](std::size_t d) { return bound_of_[d] >= 0 ? static_cast<std::size_t>(bound_of_[d]) : bounds + d; };
  std::vector<std::size_t> changed;  // discs
  std::size_t last = 0;
  for (std::size_t i = 0; i < bounds; ++i)
    if (now.closed[i] != before.closed[i]) last = i;
  for (std::size_t d = 0; d < now.kind.size(); ++d) {
    const bool turned = now.kind[d] == ConstraintStates::Kind::slips && now.slip[d].direction.dot(before.slip[d].direction) < 0;
    if (now.kind[d] == before.kind[d] && !turned) continue;
    changed.push_back(d);
    last = std::max(last, place(d));
  }
  for (const std::size_t d : changed)
    if (place(d) != last) now.kind[d] = before.kind[d], now.slip[d] = before.slip[d];
  for (std::size_t i = 0; i < bounds; ++i)
    if (i != last) now.closed[i] = before.closed[i];
}

double CondensedProgramme::residual(const VectorXd& x, const VectorXd& nu) const
{
  VectorXd y = x - step_.cwiseProduct(gradient(x, nu));
  for (const auto& bound : set_.bounds()) y[bound.index] = std::max(y[bound.index], bound.lower);
  for (std::size_t d = 0; d < bound_of_.size(); ++d) {
    const auto& disc = set_.discs()[d];
    const double radius = bound_of_[d] >= 0 ? disc.coefficient * y[disc.normal] : disc.radius;
    const Vector2d w = from_centre(disc, y);
    if (const double length = w.norm(); length > radius)
      for (int k = 0; k < disc.size(); ++k) y[disc.index[static_cast<std::size_t>(k)]] += (radius / length - 1) * w[k];
  }
  double square = (x - y).cwiseProduct(own_).dot(x - y);
  if (motions() > 0) square += system_->square(system_->lack(x, nu, loads_.e));
  return std::sqrt(square);
}

double CondensedProgramme::size(const VectorXd& x) const
{
  const double square = x.cwiseProduct(own_).dot(x);
  return std::sqrt(square > 0 || motions() == 0 ? square : system_->square(loads_.e));
}

double CondensedProgramme::friction_power(const VectorXd& x, const VectorXd& step) const
{
  const VectorXd moved = system_->push(step);
  double power = 0;
  for (std::size_t d = 0; d < bound_of_.size(); ++d)
    if (bound_of_[d] >= 0) power -= from_centre(set_.discs()[d], x).dot(from_centre({set_.discs()[d].index}, moved));
  return power;
}

double CondensedProgramme::slip(const VectorXd& step) const
{
  const VectorXd moved = system_->push(step);
  double most = 0;
  for (const auto& disc : set_.discs()) most = std::max(most, from_centre({disc.index}, moved).norm());
  return most;
}

double CondensedProgramme::opening(const VectorXd& step) const
{
  const VectorXd moved = system_->push(step);
  double most = 0;
  for (const auto& bound : set_.bounds()) most = std::max(most, moved[bound.index]);
  return most;
}

double CondensedProgramme::rounding(const VectorXd& x, const VectorXd& nu) const
{
  const VectorXd sum = system_->size_of_give(x) + loads_.b.cwiseAbs();
  return std::numeric_limits<double>::epsilon() *
         std::sqrt(sum.cwiseProduct(step_).cwiseProduct(step_).cwiseProduct(own_).dot(sum) + system_->square_of_rounding(x, nu));
}

Guess CondensedProgramme::guess_of(const ConstraintStates& states) const
{
  Guess guess{{}, true, VectorXd::Zero(unknowns()), softening_};
  auto& result = guess.moves;
  auto& base = guess.base;
  const auto bounds = set_.bounds();
  const auto discs = set_.discs();
  std::vector<std::size_t> move_of(bounds.size(), 0);
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!states.closed[i]) {
      base[bounds[i].index] = bounds[i].lower;
      continue;
    }
    move_of[i] = result.size();
    result.push_back({{bounds[i].index, -1, -1}, {1, 0, 0}, {1, 0, 0}, 0});
  }
  for (std::size_t d = 0; d < discs.size(); ++d) {
    const auto& disc = discs[d];
    const auto& slip = states.slip[d];
    const auto at = [&](int k) { return disc.index[static_cast<std::size_t>(k)]; };
    if (states.kind[d] == ConstraintStates::Kind::sticks) {
      for (int k = 0; k < disc.size(); ++k) result.push_back({{at(k), -1, -1}, {1, 0, 0}, {1, 0, 0}, 0});
      continue;
    }
    for (int k = 0; k < disc.size(); ++k) base[at(k)] = disc.centre[static_cast<std::size_t>(k)];
    if (states.kind[d] == ConstraintStates::Kind::gone) continue;
    if (const int bound = bound_of_[d]; bound >= 0) {
      auto& move = result[move_of[static_cast<std::size_t>(bound)]];
      for (int k = 0; k < disc.size(); ++k) {
        move.index[static_cast<std::size_t>(k) + 1] = at(k);
        move.trial[static_cast<std::size_t>(k) + 1] = disc.coefficient * slip.direction[k];
      }
      guess.symmetric = false;
    } else {
      for (int k = 0; k < disc.size(); ++k) base[at(k)] += slip.radius * slip.direction[k];
    }
    if (disc.size() == 2 && std::isfinite(slip.curvature)) {
      const double u = -slip.direction[1], v = slip.direction[0];
      result.push_back({{at(0), at(1), -1}, {u, v, 0}, {u, v, 0}, slip.curvature});
    }
  }
  return guess;
}

void CondensedProgramme::solve(const ConstraintStates& states, VectorXd& x, VectorXd& nu)
{
  system_->solve(guess_of(states), loads_.b, loads_.e, x, nu);
}

}  // namespace mortise::qp
