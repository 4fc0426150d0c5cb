// Where a body's surface has passed through itself: the legs of a fork, the two faces of a slit.
//
// An edge of a facet passes through another facet of the same body that it did not pass through before. Neighbours cannot cross,
// nor can what rotates, be it a linearised rotation: x + W x, W skew, is one to one. What counts came from in front of the facet,
// with an opposed normal; from behind, material is turned inside out, which is another fault.
#pragma once

#include "contact/interpenetration.hpp"

namespace mortise::contact {

/// Places of bodies that stand in the same body (Interpenetration::other is the body): nodes, middles of facets, and middles of
/// what edges have between two facets. The depth is the distance to the nearest facet that the place was in front of. Ordered by
/// bodies: the same on every rank. `before`, `now`, `sides` as in find_interpenetrations(). Left out are faces on the two sides
/// of a contact, faces that lay on each other from the start (find_doubled_faces()), and places less deep than `least`, a part of
/// the longest displacement within the body against its mean, or than 1.5 times what the smooth surfaces of both stand out of
/// their facets. Work: a look into the tree of its rank's faces for each face, and of faces near other ranks' into theirs; where
/// something crosses, the body's whole surface on every rank. Collective.
std::vector<Interpenetration> find_self_crossings(const mesh::Surface& before, const mesh::Surface& now,
                                                  const std::function<ContactSides()>& sides, double least,
                                                  fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
