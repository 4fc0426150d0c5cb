// Of two surfaces the parts that can meet: a roller sees a seventieth of its ring.
#pragma once

#include "contact/mortar.hpp"

namespace mortise::contact {

/// Lengths of a pair, over all ranks.
struct PairSize {
  double reach;                                 ///< search_distances()
  double extent = 0;                            ///< diagonal of the smaller side
  double secondary_face = 0, primary_face = 0;  ///< longest distance between two corners of a face
};
/// Collective.
std::vector<PairSize> measure(std::span<const Pair> pairs, const Communicator& comm);

/// The normal of a node depends on no face farther away than this many faces: those round it, and at a border those round the
/// nodes that its curvature is continued from, which may have been continued themselves, see find_surface_nodes(); and those that
/// tell kinks, see find_kinks().
inline constexpr double rings = 9;
/// Faces of second order stand out of their corners.
inline constexpr double slack = 1.5;

/// This rank's secondary faces that lie near the primary side, and enough of those round them that every node within reach has
/// all its faces, and the normals that it has on the whole surface. All of them over an obstacle. Collective.
mesh::Surface near_secondary(const Pair& pair, const PairSize& size, const Communicator& comm);

}  // namespace mortise::contact
