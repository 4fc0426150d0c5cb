// Preloaded bolts: a bolt is two bodies that are bonded across a section through its shank, the pretension section, and drawn
// together there.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"

namespace mortise::constraint {

/// The axis of a bolt that lies on an axis of revolution or of a sector, a unit vector; of others none.
using AxisOf = std::function<std::optional<Point>(const Preload&)>;

/// The pretension section of each preload, over the rows of `contacts` that stand on this rank. The direction is the mean of the
/// nodes' normals by area, without what supports hold of both sides at some of them: what a plane of symmetry leaves of a bolt is
/// drawn along the plane, as the whole is. On an axis it is the axis, since nothing moves as a whole across it. Throws
/// Error(bad_input) that names the contact if its sides do not meet, or if its normals have no mean (a closed surface is no
/// section). `dimension`: 2 or 3. Collective.
std::vector<PretensionSection> find_pretension_sections(const Contacts& contacts, std::span<const Preload> preloads,
                                                        int dimension, const AxisOf& axis, const Communicator& comm);

}  // namespace mortise::constraint
