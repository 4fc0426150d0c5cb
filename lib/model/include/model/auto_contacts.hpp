// `contacts: auto`: contacts of all bodies that face each other.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/context.hpp"
#include "base/warning.hpp"
#include "contact/pairing.hpp"
#include "model/deck.hpp"
#include "model/model.hpp"
#include "partition/decomposition.hpp"

namespace mortise::model {

/// Replaces the entry {auto: true} of `contacts`, if there is one, by a contact for each pair of bodies and patch found, and adds
/// their faces to the decomposition as boundaries `contact.secondary` and `contact.primary`. Returns what was found, in the order
/// of these contacts. Errors go to the document. Collective.
std::vector<contact::ContactCandidate> resolve_auto(const Deck& deck, Contacts& contacts, deck::Document& document,
                                                    partition::Decomposition& decomposition, const Context& context);

/// Lists the candidates found, the first ones or `all`; "no_pair_found" if there are none. Prints nothing if the deck has no such
/// entry. Collective.
std::optional<Warning> print_contact_candidates(const std::vector<contact::ContactCandidate>& candidates, const Deck& deck,
                                                const Contacts& contacts, const partition::Decomposition& decomposition, bool all,
                                                const Context& context);

/// Two bodies without a contact between them that have moved into each other.
struct CrossedBodies {
  contact::Bodies bodies;
  double depth;  ///< a length: where the way out is shortest
  Point at;      ///< in the middle of what crossed, before it moved
};

/// All of them, the deepest first, where the deck leaves it to the program to find contacts; depths below a hundredth of the
/// largest displacement are none. `displacement`: of each subdomain, nodes x dimension. Collective.
std::vector<CrossedBodies> crossed_bodies(const Model& model, const std::vector<Eigen::VectorXd>& displacement,
                                          const Communicator& comm);

}  // namespace mortise::model
