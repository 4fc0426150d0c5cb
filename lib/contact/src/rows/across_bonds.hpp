// Contacts that go on across a bond: of one body in two parts, or from one sector to the next.
//
// The bond makes one of a node a of its secondary boundary and the place b opposite, u_a = R u_b with the rotation R of a sector.
// Of a contact both have a row, which are then one and the same if nothing else holds: as many rows as unknowns. So b has one row
// for both,
//
//     (d_b row_b + sum_a w_a d_a row_a) / (d_b + sum_a w_a d_a),    d: areas,
//
// a none, and the bond keeps its multiplier at a. Where the meshes do not match, a lies between two nodes of the contact's edge
// and is shared between them, w being the linear functions there. Constant pressures pass as before: all that a's row pushes is
// pushed by others with the same pressure. So are the rows of a place between nodes; its images are the nodes that bear it across
// the bond.
#pragma once

#include <span>

#include "constraint/constraints.hpp"
#include "contact/mortar.hpp"

namespace mortise::contact {

/// Joins these rows of each contact that is neither bonded nor cyclic itself; bonded ones may not have rows yet. What has nothing
/// opposite, or other tangents there, stays as it is. Collective.
void join_across_bonds(std::span<const Pair> pairs, constraint::Contacts& contacts, const Communicator& comm);

}  // namespace mortise::contact
