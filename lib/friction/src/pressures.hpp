// Pressures of an unfinished solution, and which contacts matter.
#pragma once

#include <cstddef>
#include <vector>

#include "feti/dual_problem.hpp"

namespace mortise::friction {

/// Cover of points below which they have a force but no pressure of their own.
inline constexpr double narrow_cover = 0.35;

/// What multipliers `x` press with: the largest pressure of each contact, the same on every rank.
class Pressures {
 public:
  /// Collective. `problem` outlives it.
  Pressures(const feti::DualProblem& problem, const Vector& x);

  /// The pressure that a multiplier makes at a point of this rank; 0 where a point has none of its own or is bonded.
  double of(std::size_t point, double multiplier) const;
  std::size_t contacts() const { return largest_.size(); }
  double largest(std::size_t contact) const { return largest_[contact]; }
  /// Whether a contact only touches: it presses with less than a thousandth of the largest pressure, and its force is less than a
  /// thousandth of what acts on any body that is loaded. So a block's weight matters beside a press.
  bool idle(std::size_t contact) const;

 private:
  const feti::DualProblem& problem_;
  std::vector<double> largest_, force_;  // of each contact: pressure, sum of normal forces
  double all_ = 0;                       // the largest pressure
  double least_load_ = 0;                // of the bodies that are loaded; infinite if there are none
};

}  // namespace mortise::friction
