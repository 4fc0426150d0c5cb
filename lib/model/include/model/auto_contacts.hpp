// `contacts: auto`: contacts of all bodies that face each other.
#pragma once

#include <optional>
#include <vector>

#include "base/context.hpp"
#include "base/warning.hpp"
#include "contact/pairing.hpp"
#include "model/deck.hpp"
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

}  // namespace mortise::model
