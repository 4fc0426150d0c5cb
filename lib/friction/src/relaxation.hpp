// Steps of a fixed point.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/communicator.hpp"

namespace mortise::friction {

// How far to go towards the next bounds of the fixed point: Aitken's rule, which makes a swing about a point converge there
// [Irons and Tuck, IJNME 1 (1969)]. Steps that grow in their own direction lead away from a point behind: all the way, for where
// nothing holds a body, as a plug on its way out of its seat, bounds that fall to nothing are what shows it.
class Relaxation {
 public:
  explicit Relaxation(const Communicator& comm) : comm_(comm) {}

  double operator()(const std::vector<double>& now, const std::vector<double>& next)
  {
    std::vector<double> step;  // infinite bounds are left in one go
    for (std::size_t i = 0; i < now.size(); ++i)
      step.push_back(std::isinf(now[i]) || std::isinf(next[i]) ? 0.0 : next[i] - now[i]);
    double product = 0, square = 0;
    for (std::size_t i = 0; i < step_.size(); ++i) {
      product += step_[i] * (step[i] - step_[i]);
      square += (step[i] - step_[i]) * (step[i] - step_[i]);
    }
    product = comm_.sum(product);
    square = comm_.sum(square);
    growing_ = product > 0 ? growing_ + 1 : 0;
    if (square > 0) part_ = product > 0 ? 1.0 : std::clamp(-part_ * product / square, shortest, 1.0);
    step_ = std::move(step);
    return part_;
  }
  // Of the last steps, how many were each longer than the one before, in its direction.
  int growing() const { return growing_; }

 private:
  static constexpr double shortest = 0.05;
  const Communicator& comm_;
  std::vector<double> step_;  // the one before
  double part_ = 1;
  int growing_ = 0;
};

}  // namespace mortise::friction
