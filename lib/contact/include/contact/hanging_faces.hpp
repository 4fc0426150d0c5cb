// Outer faces of one body that lie on others with other corners: nodes of one side hang beside those of the other, or two meshes
// end at a seam that was not merged.
#pragma once

#include <array>
#include <vector>

#include "base/communicator.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// Two outer faces of one body with opposed normals, the middle of one of them on the other.
struct HangingFaces {
  int body;
  std::array<Global, 2> faces;  ///< Surface::face_id, the lower one first
  Global middle_of;             ///< the one of them
  Point at;                     ///< the middle of that one, or of a part of it
};

/// All of them but those of find_doubled_faces(), ordered by `middle_of`: the same on every rank. Surfaces lie on each other
/// where the smooth ones through their nodes are apart by less than a quarter of what these stand out of both facets and 1e-4 of
/// a face's size, and in each other by next to nothing; the two faces of one cell never do. `skin`: the outer surface of all
/// bodies, this rank's faces, numbered as in partition::outer_surface(). Work: a look into the tree of its rank's faces for each
/// face. Collective.
std::vector<HangingFaces> find_hanging_faces(const mesh::Surface& skin, fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
