// The deck as a file.
#pragma once

#include <string>

#include "base/communicator.hpp"
#include "command_line.hpp"
#include "model/deck.hpp"

namespace mortise {

/// The text of the deck, read by one rank. Collective.
std::string read_text(const std::string& file, const Communicator& comm);

/// The deck, with what the command line changes. Throws Error(bad_input) with all errors of the document; then results of an
/// earlier run do not stay behind as if they were this deck's. Collective.
model::Deck read_deck(deck::Document& document, const CommandLine& command_line, const Communicator& comm);

}  // namespace mortise
