// Preloaded bolts: a bolt is two bodies that are bonded across a cut through its shank, and the cut is drawn together.
#pragma once

#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"

namespace mortise::constraint {

/// The cut of each preload, over the rows of `contacts` that stand on this rank. The direction is the mean of the points' normals
/// by area; in axisymmetry it is the axis, since nothing moves as a whole across it. Throws Error(bad_input) that names the
/// contact if its sides do not meet, or if its normals have no mean (a closed surface is no cut). Collective.
std::vector<Cut> find_cuts(const Contacts& contacts, std::span<const Preload> preloads, bool axisymmetric,
                           const Communicator& comm);

}  // namespace mortise::constraint
