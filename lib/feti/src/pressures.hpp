// Pressures of an unfinished solution, and which contacts matter.
#pragma once

#include <cstddef>
#include <vector>

#include "feti/dual_problem.hpp"

namespace mortise::feti {

/// Cover of points below which they have a force but no pressure of their own.
inline constexpr double narrow_cover = 0.35;

/// What multipliers `x` press with. Points are taken together by contact and by group of bodies (BodyGroups): the parts of
/// a contact, each with its largest pressure, the same on every rank.
class Pressures {
 public:
  /// Collective. `problem` outlives it.
  Pressures(const DualProblem& problem, const Vector& x);

  /// The pressure that a force makes at a point of this rank; 0 where a point has none of its own or is bonded.
  double of(std::size_t point, double force) const;
  std::size_t parts() const { return group_.size(); }
  /// Of a point of this rank.
  std::size_t part_of(std::size_t point) const { return part_[point]; }
  double largest(std::size_t part) const { return largest_[part]; }
  /// The sum of normal forces that press.
  double force(std::size_t part) const { return force_[part]; }
  /// Below this a force does not matter: a thousandth of the least load of a body in the part's group, or of the largest force of
  /// a contact there if none is loaded.
  double force_that_counts(std::size_t part) const;
  /// Whether it only touches: it presses with less than a thousandth of the largest pressure in its group of bodies, and its
  /// force is less than a thousandth of what acts on any body there that is loaded. So a block's weight matters beside a press.
  bool idle(std::size_t part) const;

 private:
  void find_parts();

  const DualProblem& problem_;
  std::vector<std::size_t> part_;        // of each point of this rank
  std::vector<std::size_t> group_;       // of each part
  std::vector<double> largest_, force_;  // of each part: pressure, sum of normal forces
  std::vector<double> all_;              // of each group: the largest pressure,
  std::vector<double> least_load_;       // and that of its bodies that are loaded; infinite if there are none
};

}  // namespace mortise::feti
