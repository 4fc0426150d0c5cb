// One run, from a deck that has been read to results on disk.
#pragma once

#include "base/context.hpp"
#include "base/error.hpp"
#include "command_line.hpp"
#include "deck.hpp"

namespace mortise {

/// mesh -> subdomains -> constraint rows -> dual problem -> multipliers -> displacements -> fields -> files. Collective.
ExitStatus run(const Deck& deck, deck::Document& document, const CommandLine& command_line, const Context& context);

}  // namespace mortise
