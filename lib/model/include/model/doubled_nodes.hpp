// Seams that a mesh leaves open inside a body.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"
#include "model/model.hpp"

namespace mortise::model {

/// A body with faces that lie on each other and are not connected.
struct DoubledNodes {
  int body;         ///< of the parts of a group or instance the first
  long long nodes;  ///< places that have two nodes
  Point at;         ///< that one of them that is nearest to their middle
};

/// A body with faces that lie on others with other corners.
struct HangingNodes {
  int body;
  long long faces;  ///< that lie on others
  Point at;         ///< the middle of one of them, that is nearest to the middle of all
};

struct OpenSeams {
  std::vector<DoubledNodes> doubled;
  std::vector<HangingNodes> hanging;
};

/// All bodies whose outer faces come twice at one place (contact::find_doubled_faces()), but for those that are the two sides of
/// a contact or bond, or lie on others (contact::find_hanging_faces()), but for those that a contact has, or supports hold on
/// both sides; most nodes or faces first. The bodies of one group or instance (mesh::Body) count as one, whose parts a mesh
/// may leave side by side. Collective.
OpenSeams open_seams(const Model& model, const Communicator& comm);

}  // namespace mortise::model
