// Whether the cuts of a cyclic sector fit each other.
#pragma once

#include "near.hpp"

namespace mortise::contact {

/// The cuts are one surface once turned; sides that do not lie on each other would be tied all the same, and are an error. `gap`:
/// the widest of this rank's surface nodes, `covered`: the area in common of these. Throws Error(bad_input). Collective.
void require_one_surface(const Pair& pair, const PairSize& size, double gap, double covered, const Communicator& comm);

}  // namespace mortise::contact
