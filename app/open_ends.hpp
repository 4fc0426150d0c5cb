// What a run leaves open: where contact is not known to a cell, and where a run is stuck that did not converge.
#pragma once

#include "base/log.hpp"
#include "deck.hpp"
#include "friction/friction.hpp"
#include "io/summary.hpp"

namespace mortise {

/// Adds it to the summary, whose contacts stand there already.
void add_open_ends(const friction::Result& solved, const Deck& deck, io::StateSummary& summary);

/// The lines about it: none where everything is decided.
void print_open_ends(const io::StateSummary& summary, Log& log);

}  // namespace mortise
