// Which faces of different bodies face each other: lines along the normals of all faces, both ways, and what they cross.
#pragma once

#include <vector>

#include "contact/pairing.hpp"
#include "pairing/skin.hpp"

namespace mortise::contact {

/// Of the facets of a skin.
Tree tree_of(const std::vector<FaceGeometry>& faces);

/// Where a line leaves or enters a body.
struct Crossing {
  double s;  ///< along the line
  int face;
  bool entered;  ///< the face looks back along the line
};

/// What the line through `x` along `direction` crosses between -length and length, but the face it starts from.
std::vector<Crossing> cross_skin(const Point& x, const Point& direction, double length, int from, const Skin& skin,
                                 const Tree& facets);

/// Whether nothing of the two bodies, in a gap nothing at all, lies between the start of the line and a crossing.
bool in_sight(const Crossing& seen, int from, const std::vector<Crossing>& crossings, const Skin& skin);

/// Two faces that face each other, and how far apart they are at one place.
struct Facing {
  int face, other;
  double gap;
};

/// All faces that face each other but those of bodies in `known`, ordered. Collective.
std::vector<Facing> find_facing(const Skin& skin, const Tree& facets, const Lengths& lengths, const std::set<Bodies>& known,
                                const Communicator& comm);

}  // namespace mortise::contact
