// What the names of a deck mean on its mesh.
#pragma once

#include "base/context.hpp"
#include "contact/pairing.hpp"
#include "model/model.hpp"
#include "partition/decomposition.hpp"

namespace mortise::model {

struct Resolution {
  partition::Decomposition decomposition;  ///< with a boundary for each pattern, and two for each contact that was found
  Contacts contacts;
  std::vector<contact::ContactCandidate> found;  ///< by `contacts: auto`
  Temperatures temperatures;
};

/// Wild cards and `contacts: auto` on the mesh of `decomposition`, and files with temperatures. Throws Error(bad_input) with all
/// errors of the document, those of names that the mesh lacks among them. Collective.
Resolution resolve(const Deck& deck, deck::Document& document, partition::Decomposition decomposition, const Context& context);

}  // namespace mortise::model
