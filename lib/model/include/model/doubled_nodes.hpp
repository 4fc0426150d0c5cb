// Seams that a mesh leaves open inside a body.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"
#include "model/model.hpp"

namespace mortise::model {

/// A body with faces that lie on each other and are not connected.
struct DoubledNodes {
  int body;
  long long nodes;  ///< places that have two nodes
  Point at;         ///< that one of them that is nearest to their middle
};

/// All bodies whose outer faces come twice at one place (contact::find_doubled_faces()), but for those that are the two sides of
/// a contact or bond; most nodes first. Collective.
std::vector<DoubledNodes> doubled_nodes(const Model& model, const Communicator& comm);

}  // namespace mortise::model
