// Preloaded bolts: a bolt is two bodies that are bonded across a section through its shank, the pretension section, and drawn
// together there.
#pragma once

#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"

namespace mortise::constraint {

/// The pretension section of each preload, over the rows of `contacts` that stand on this rank. The direction is the mean of the
/// nodes' normals by area; in axisymmetry it is the axis, since nothing moves as a whole across it. Throws Error(bad_input) that
/// names the contact if its sides do not meet, or if its normals have no mean (a closed surface is no section). Collective.
std::vector<PretensionSection> find_pretension_sections(const Contacts& contacts, std::span<const Preload> preloads,
                                                        bool axisymmetric, const Communicator& comm);

}  // namespace mortise::constraint
