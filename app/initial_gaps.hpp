// What contacts start with: gaps, overlaps, areas that touch.
#pragma once

#include <vector>

#include "base/context.hpp"
#include "contact/fit.hpp"
#include "deck.hpp"

namespace mortise {

/// A line a contact, of the first contacts or of `all`, and a warning for each overlap that no `interference` asks for.
/// `gaps`: the same on every rank.
void report_initial_gaps(const std::vector<contact::InitialGap>& gaps, const Deck& deck, bool all, const Context& context);

}  // namespace mortise
