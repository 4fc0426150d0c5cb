// Steps of a fixed point.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

// How much of a change of bounds the normal forces answer with, by Tresca problems one after the other.
class Response {
 public:
  explicit Response(const Communicator& comm) : comm_(comm) {}

  // A problem with the bounds `given` asks for those `wanted`. What changes by no more than rounding tells nothing. Collective.
  void note(const std::vector<double>& given, const std::vector<double>& wanted)
  {
    if (before_) {
      std::array<double, 3> squares{0, 0, 0};  // of the changes of bounds and answers, of the answers
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (!std::isfinite(given[i]) || !std::isfinite(before_->given[i])) continue;
        squares[0] += std::pow(given[i] - before_->given[i], 2);
        squares[1] += std::pow(wanted[i] - before_->wanted[i], 2);
        squares[2] += wanted[i] * wanted[i];
      }
      comm_.sum_in_place(squares);
      if (squares[0] > step * step * squares[2]) part_ = std::sqrt(squares[1] / squares[0]);
    }
    before_ = Answer{given, wanted};
  }
  // The part, of the last change that tells it; nothing if none has.
  const std::optional<double>& part() const { return part_; }

 private:
  struct Answer {
    std::vector<double> given, wanted;
  };
  static constexpr double step = 1e-3;  // change, relative, that is more than rounding
  const Communicator& comm_;
  std::optional<Answer> before_;
  std::optional<double> part_;
};

}  // namespace mortise::friction
