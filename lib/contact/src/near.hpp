// Of two surfaces the parts that can meet: a roller sees a seventieth of its ring.
#pragma once

#include "contact/mortar.hpp"

namespace mortise::contact {

/// Lengths of a pair, over all ranks.
struct PairSize {
  double reach;                                 ///< search_distances()
  double secondary_face = 0, primary_face = 0;  ///< longest distance between two corners of a face
};
/// Collective.
std::vector<PairSize> measure(std::span<const Pair> pairs, const Communicator& comm);

/// This rank's faces of both sides that lie near the other one, and enough of those round them that every node within reach has
/// all its faces, and the normals that it has on the whole surface. All of the secondary side over an obstacle.
struct NearFaces {
  mesh::Surface secondary, primary;
};
/// Collective.
NearFaces near_faces(const Pair& pair, const PairSize& size, const Communicator& comm);

}  // namespace mortise::contact
