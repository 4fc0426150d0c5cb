// Which faces of contacts lie on curved surfaces of the geometry that was meshed.
#pragma once

#include <vector>

#include "contact/mortar.hpp"
#include "model/deck.hpp"
#include "partition/decomposition.hpp"

namespace mortise::model {

/// This rank's faces of those contacts that ask the geometry, with the surfaces that they are parts of; instances of a part have
/// theirs where they stand.
std::vector<contact::CurvedFace> curved_faces(const Deck& deck, const partition::Decomposition& decomposition,
                                              const std::vector<contact::Pair>& pairs);

}  // namespace mortise::model
