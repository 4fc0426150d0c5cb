// Wild cards: `*` in the name of a boundary or a body stands for any text.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "model/deck.hpp"
#include "partition/decomposition.hpp"

namespace mortise::model {

/// Whether a name has a wild card.
bool is_pattern(const std::string& name);
/// Whether `text` is `pattern` with some text for every `*`.
bool matches(const std::string& pattern, const std::string& text);
/// The text that the only `*` of the pattern stands for, if `text` matches it.
std::optional<std::string> wildcard_text(const std::string& pattern, const std::string& text);

/// Whether a body is meant by a name: its own, that of its instance or of its group, or a pattern that one of these matches.
bool matches_name(const mesh::Body& body, const std::string& name);

/// The entry of `bodies` that a group of the mesh has: that of its own name, else that of the first pattern which matches it,
/// else the end of the map. check_names() sees to it that patterns which match one group say the same.
std::map<std::string, fem::BodyOptions>::const_iterator body_entry(const Deck& deck, const std::string& group);

/// The contacts of the deck, one with wild cards as one for each match. Of supports and loads every pattern becomes a boundary of
/// the decomposition that has the pattern's name and all faces of all matches, once each. Patterns are compared with the
/// boundaries of the mesh or, if they hold a colon, with body:boundary for all bodies and the boundaries on them. Errors go to
/// the document. Collective.
Contacts resolve_patterns(const Deck& deck, deck::Document& document, partition::Decomposition& decomposition,
                          const Communicator& comm);

}  // namespace mortise::model
