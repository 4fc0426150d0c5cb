// What contacts start with: gaps, overlaps, areas that touch.
#pragma once

#include <vector>

#include "base/log.hpp"
#include "contact/fit.hpp"
#include "model/deck.hpp"

namespace mortise {

/// A line a contact, of the first contacts or of `all`.
void print_initial_gaps(const std::vector<contact::InitialGap>& gaps, const model::Contacts& contacts, bool all, Log& log);

}  // namespace mortise
