// Contacts that end in the cuts of a sector: they go on in the next one.
//
// The bond of the cuts makes one of a node a of its secondary boundary and its image b on the primary one, u_a = R u_b. Of a contact
// both have a row, which are then one and the same if nothing else holds: as many rows as unknowns. So b has one row for both,
//
//     (d_b row_b + sum_a w_a d_a row_a) / (d_b + sum_a w_a d_a),    d: areas,
//
// a none, and the bond keeps its multiplier at a. Where the meshes of the cuts do not match, a lies between two nodes of the
// contact's edge and is shared between them, w being the linear functions there. Constant pressures pass as before: all that a's
// row pushes is pushed by others with the same pressure.
#pragma once

#include <span>

#include "constraint/constraints.hpp"
#include "contact/mortar.hpp"

namespace mortise::contact {

/// Joins these rows of the contacts that are neither bonded nor cyclic themselves; bonded ones may not have rows yet. What has no
/// image, or other tangents there, stays as it is. Collective.
void join_across_cuts(std::span<const Pair> pairs, constraint::Contacts& contacts, const Communicator& comm);

}  // namespace mortise::contact
