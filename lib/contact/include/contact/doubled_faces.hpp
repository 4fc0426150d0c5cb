// Outer faces of one body that lie at the same place and have nodes of their own: seams that a mesher left open, or cracks.
#pragma once

#include <array>
#include <vector>

#include "base/communicator.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// Two numbers for one place.
struct DoubledNode {
  std::array<Global, 2> numbers;  ///< Surface::node_id, the lower one first
  Point at;                       ///< of the lower one
};

/// Two outer faces of one body with their corners at the same places and opposed normals.
struct DoubledFaces {
  int body;
  std::array<Global, 2> faces;     ///< Surface::face_id, the lower one first
  std::vector<DoubledNode> nodes;  ///< where they have a node each; not those that they share, as at the front of a crack
};

/// All of them, ordered by faces: the same on every rank. Places are the same that are apart by less than 1e-4 of a face's size,
/// as files with few digits leave them. `skin`: the outer surface of all bodies, this rank's faces. Work: sorts the faces'
/// middles along a line. Collective.
std::vector<DoubledFaces> find_doubled_faces(const mesh::Surface& skin, fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
