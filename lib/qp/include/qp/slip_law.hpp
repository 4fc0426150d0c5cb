// Radii of discs that follow the solution, as those of Coulomb friction do.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "base/tpetra.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

struct SlipLaw {
  /// The radii that the law gives at x; without x those to begin with, before any force is known. One for each disc.
  std::function<std::vector<double>(const Vector* x)> radii;
  /// Whether steps that make the residual larger than it has been of late are shortened: more of them, for where nothing else
  /// ends.
  bool cautious = false;
};

/// Half way from `radii`, which leave no feasible point, back to those `before`: twice as large where these were infinite.
std::vector<double> half_way_back(std::vector<double> radii, std::span<const double> before);

/// The radii of one solve by a law.
class FollowedRadii {
 public:
  /// From the radii that `set` has, which it gives new ones. All outlive it.
  FollowedRadii(const SlipLaw& law, FeasibleSet& set, const Communicator& comm);
  /// If `apply`, gives the set the radii that belong to the point x. Returns the norm of their change, made or not. Collective.
  double update(const Vector& x, bool apply);
  /// Goes half way back to the radii before, because the updated ones leave no feasible point: half_way_back().
  void retreat();
  bool cautious() const { return law_.cautious; }

 private:
  const SlipLaw& law_;
  FeasibleSet& set_;
  const Communicator& comm_;
  std::vector<double> now_, before_;
};

}  // namespace mortise::qp
