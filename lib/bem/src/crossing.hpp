// Surfaces that are no border of a body, though closed.
#pragma once

#include "bem/panels.hpp"

namespace mortise::bem {

/// Seen from a point of the border of a body, the border fills half of all directions: the double layer of a constant is -1/2
/// there, and less by a whole number where the point lies in another part of the body, as it does where the surface crosses
/// itself, or more where parts lie on each other. `double_layer`: m x n, integrated over panels. Throws Error(bad_input), with a
/// place.
template <int D>
void require_border(const PanelsIn<D>& panels, const Eigen::MatrixXd& double_layer);

}  // namespace mortise::bem
