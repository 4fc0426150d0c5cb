// Displacements that are not small: the method looks for contact, and sums forces, on the undeformed bodies.
#pragma once

#include <string>
#include <vector>

#include "base/warning.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// "large_displacement": a node moves by more than 5 % of its body's size (`sizes`: body_sizes()). Collective.
std::vector<Warning> large_displacements(const partition::Decomposition& decomposition, const std::vector<double>& sizes,
                                         const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

/// "inverted_cells": at a node or an integration point the deformed cell has no volume or a negative one, det d(x + u)/d(xi) <=
/// 0. Nodes where the undeformed cell is collapsed do not count. Collective.
std::vector<Warning> inverted_cells(const partition::Decomposition& decomposition,
                                    const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

/// "folded_cells": before any load, det dx/d(xi) is negative at a node or an integration point of a cell, as where a node between
/// two corners lies beyond the quarter point of its edge. Collapsed bricks are not. Collective.
std::vector<Warning> folded_cells(const partition::Decomposition& decomposition, const Communicator& comm);

}  // namespace mortise::post
