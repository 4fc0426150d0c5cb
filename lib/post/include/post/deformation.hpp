// Displacements that are not small: the method looks for contact, and sums forces, on the undeformed bodies.
#pragma once

#include <string>
#include <vector>

#include "base/warning.hpp"
#include "contact/state.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// "large_displacement": a node moves by more than 5 % of its body's size (`sizes`: body_sizes()). Collective.
std::vector<Warning> large_displacements(const partition::Decomposition& decomposition, const std::vector<double>& sizes,
                                         const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

/// "inverted_cells": at a node or an integration point the deformed cell has no volume or a negative one, det d(x + u)/d(xi) <=
/// 0. Nodes where the undeformed cell is collapsed do not count. Collective.
std::vector<Warning> inverted_cells(const partition::Decomposition& decomposition,
                                    const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

/// "long_slide": a closed contact node slides by more than the longest distance of two corners of its face; by more than a tenth
/// of that where no more nodes of the contact are closed than a facet has corners (two in planes, three in space). The jump of
/// the displacements along the surface is taken from the normal rows, so that points without friction count as well; `points` are
/// the states of contacts.nodes. Bonded and cyclic contacts do not slide. Collective.
std::vector<Warning> long_slides(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                 std::span<const contact::ContactNodeState> points, const partition::Decomposition& decomposition,
                                 const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

}  // namespace mortise::post
