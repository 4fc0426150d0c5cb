// The largest and the smallest values of a result, over the whole model or some part of it.
#pragma once

#include <limits>
#include <vector>

#include "contact/state.hpp"
#include "deck/local_axes.hpp"
#include "fem/quantity.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::post {

struct Interior;
struct Probes;

/// What is looked for, and at which of this rank's nodes.
struct ExtremeProbe {
  fem::Quantity quantity = fem::Quantity::von_mises;
  bool smallest = false;
  std::vector<bool> on_body;             ///< of the catalogue
  std::vector<std::vector<bool>> nodes;  ///< of each subdomain, where a boundary is meant; empty: all of the bodies
  /// Of each contact the nodes of its secondary side, for pressures; else empty.
  std::vector<std::vector<bool>> contact_nodes;
  std::optional<deck::LocalAxes> axes = {};  ///< that components are along; none: those of the model
};

/// The same on every rank.
struct Extreme {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN if no value is a number
  Point at = Point::Zero();
  int body = -1;
};

/// What `probes.extremes` ask for. Values are looked at in the nodes, in each material that meets there, and at the points inside
/// boundary elements that something asks for; pressures are those averaged over the faces at a node. Of equal values that at the
/// node with the lowest number counts. `displacement`: of each subdomain; `surfaces`: of each of `pairs`. Collective.
std::vector<Extreme> find_extremes(const partition::Decomposition& decomposition, const Probes& probes,
                                   const std::vector<Eigen::VectorXd>& displacement, const StressField& stress,
                                   const Interior& interior, std::span<const contact::Pair> pairs,
                                   std::span<const contact::SurfaceState> surfaces, const Communicator& comm);

}  // namespace mortise::post
