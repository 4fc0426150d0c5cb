#include "qp/budget.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mortise::qp {

namespace {

constexpr double less = 0.7;  // times the best so far is better

bool improve(double value, double& best)
{
  if (!(value < less * best)) return false;
  best = value;
  return true;
}

}  // namespace

Budget::Budget(Hessian& hessian, std::optional<int> given, bool steady) : hessian_(hessian), given_(given), steady_(steady)
{
  start({});
}

void Budget::start(std::optional<int> patience)
{
  begin_ = better_ = hessian_.count();
  patience_ = patience;
  end_ = given_ ? *given_ : begin_ + most;
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
  bool better = improve(std::max(progress.projected_gradient, progress.equality), best_.residual);
  better = improve(progress.error, best_.error) || better;
  better = improve(change_of_bounds, best_.bounds) || better;
  if (changes && *changes < best_.changes) {
    best_.changes = *changes;
    better = true;
  }
  if (!better) return;
  better_ = hessian_.count();
  set_limit();
}

void Budget::set_limit()
{
  int limit = end_;
  if (patience_)
    limit = std::min(limit, begin_ + *patience_);
  else if (!given_ && !steady_)
    limit = std::min(limit, better_ + stretch);
  hessian_.set_limit(limit);
}

std::string Budget::reason() const
{
  const std::string key = "solver.max_multiplications";
  if (given_) return key;
  if (hessian_.count() >= end_) return key + fmt::format(" (auto: {} products)", most);
  return key + fmt::format(" (auto: nothing became better over {} products)", stretch);
}

}  // namespace mortise::qp
