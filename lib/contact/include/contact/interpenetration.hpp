// Where bodies stand in each other: nodes of one body's surface, the middles of its facets, and the middles of what its edges
// have between two facets of another body, that lie inside that body.
//
// The nearest place c of the other surface tells on which side a place x is: inside if n . (x - c) < 0, n the mean of the normals
// of the facets that meet at c, weighted with their angles there [Baerentzen and Aanaes, IEEE TVCG 11 (2005)]. Facets in whose
// plane the body's own surface ends as well, as two bodies end in one plane of symmetry, are no way out: they are passed over.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "base/communicator.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// The faces that contacts have, the same on every rank.
struct ContactSides {
  /// Of faces, by Surface::face_id: 2 c and 2 c + 1 where they are on the two sides of contact c.
  std::map<Global, std::vector<int>> of_face;

  /// Whether two faces are on the two sides of one contact.
  bool opposite(Global face, Global other) const;
};

/// A place of one body inside another one.
struct Interpenetration {
  int body, other;  ///< that of the place, and the one that it lies in
  double depth;     ///< a length: from the place to the surface of `other`
  Point at;         ///< the place before anything moved
};

/// How deep is none, and how deep to look.
struct DepthRange {
  double least;    ///< what lies deeper by at most this than anything of the same two bodies did before is left out
  double largest;  ///< the length by which two surfaces may have come nearer to each other; half a face is looked for in any case
};

/// All places inside other bodies, ordered by bodies: the same on every rank. Bodies that stood in each other before are found if
/// they did by more than facets of bodies that fit do: 1.5 times what the smooth surfaces of both stand out of theirs, each about
/// s / 2 tan(phi / 4), s the facet's size and phi its angle with its neighbours, or a hundredth of a face. `before`, `now`: the
/// outer surface of all bodies, this rank's faces, the same faces with the points before and after something moved. Places are
/// left out whose faces, and those of the other body next to them, are the two sides of a contact, and where facets that fit
/// cross if contacts have a third body on the other sides of both; `sides` says so, and is called on all ranks or on none.
/// Collective.
std::vector<Interpenetration> find_interpenetrations(const mesh::Surface& before, const mesh::Surface& now, int bodies,
                                                     const std::function<ContactSides()>& sides, const DepthRange& range,
                                                     fem::Kinematics kinematics, const Communicator& comm);

/// Bodies that lie wholly inside another one, however deep: the middles of those of their faces that are outermost along the axes
/// do. One place of each, the deepest of these. Not of bodies that are in contact with each other by any face; `sides` as above.
/// Work: bodies whose box lies in that of another one times faces of that. Collective.
std::vector<Interpenetration> find_enclosed_bodies(const mesh::Surface& before, const mesh::Surface& now, int bodies,
                                                   const std::function<ContactSides()>& sides, fem::Kinematics kinematics,
                                                   const Communicator& comm);

}  // namespace mortise::contact
