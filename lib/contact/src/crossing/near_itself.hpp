// Faces of a body that may have moved through other faces of it.
#pragma once

#include "pairing/skin.hpp"

namespace mortise::contact {

/// Those of this rank's faces without which no two faces of one body that share no node can cross now: two are taken if
/// - the boxes round what they are now meet,
/// - so do what lay between their places before and what lies between their displacements, component by component, and
/// - no plane parallel to one of them, or through one of its edges and its normal, lies between their nodes.
/// `before`, `now`: the same faces. Collective.
std::vector<std::size_t> near_itself(const mesh::Surface& before, const mesh::Surface& now, fem::Kinematics kinematics,
                                     const Communicator& comm);

/// This rank's faces that may meet faces of their body on other ranks, all grown by `margin` of their size. Collective.
std::vector<std::size_t> near_other_ranks(const mesh::Surface& skin, double margin, const Communicator& comm);

}  // namespace mortise::contact
