#include "qp/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mortise::qp {

namespace {

bool improve(double value, double& best)
{
  if (!(value < Budget::Limits::less * best)) return false;
  best = value;
  return true;
}

}  // namespace

Budget::Budget(Hessian& hessian, std::optional<int> given, bool steady) : hessian_(hessian), given_(given), steady_(steady)
{
  start({});
}

void Budget::start(std::optional<Patience> patience, double goal)
{
  goal_ = goal;
  first_.reset();
  least_ = std::numeric_limits<double>::infinity();
  begin_ = better_ = hessian_.count();
  patience_ = patience;
  end_ = given_ ? *given_ : begin_ + Limits::most;
  best_ = {};
  set_limit();
}

void Budget::change_algorithm()
{
  better_ = hessian_.count();
  best_ = {};
  set_limit();
}

void Budget::note(const Progress& progress, std::optional<long long> changes, double change_of_bounds)
{
  if (progress.what != "outer") return;  // there is no residual yet, or the one before
  const double residual = std::max(progress.projected_gradient, progress.equality);
  if (!first_ && std::isfinite(residual)) first_ = {hessian_.count() - begin_, residual};
  least_ = std::min(least_, residual);
  bool better = improve(residual, best_.residual);
  better = improve(progress.error, best_.error) || better;
  better = improve(change_of_bounds, best_.bounds) || better;
  if (changes && *changes < best_.changes) {
    best_.changes = *changes;
    better = true;
  }
  if (better) better_ = hessian_.count();
  // The pace is that of late: a residual may fall at first, and stand later.
  const int spent = hessian_.count() - begin_;
  if (patience_ && first_ && spent >= Limits::look && spent - first_->first >= Limits::of_late) {
    if (foreseen() > patience_->products + patience_->near) patience_ = spent;
    first_ = {spent, least_};
  }
  set_limit();
}

// Products that the solve would take, at the pace of its residuals since `first_`, on a logarithmic scale.
double Budget::foreseen() const
{
  if (!first_ || !(least_ < first_->second)) return std::numeric_limits<double>::infinity();
  const double part = std::log(first_->second / least_) / std::max(std::log(first_->second / goal_), 0.0);
  return first_->first + (hessian_.count() - begin_ - first_->first) / std::min(part, 1.0);
}

void Budget::set_limit()
{
  int limit = end_;
  if (patience_) {
    const bool is_near = foreseen() <= hessian_.count() - begin_ + patience_->near;
    limit = std::min(
        {limit, begin_ + patience_->products + (is_near ? patience_->near : 0), std::max(begin_, better_) + Limits::look});
  } else if (!given_ && !steady_)
    limit = std::min(limit, better_ + Limits::stretch);
  hessian_.set_limit(limit);
}

std::string Budget::reason() const
{
  const std::string key = "solver.max_multiplications";
  if (given_) return key;
  if (hessian_.count() >= end_) return key + fmt::format(" (auto: {} products)", Limits::most);
  return key + fmt::format(" (auto: nothing became better over {} products)", Limits::stretch);
}

}  // namespace mortise::qp
