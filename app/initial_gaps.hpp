// What contacts start with: gaps, overlaps, areas that touch.
#pragma once

#include <vector>

#include "base/log.hpp"
#include "base/warning.hpp"
#include "contact/fit.hpp"
#include "model/deck.hpp"

namespace mortise {

/// Prints a line a contact, of the first contacts or of `all`; the overlaps that no `interference` asks for, the largest first.
/// `gaps`: the same on every rank.
std::vector<Warning> report_initial_gaps(const std::vector<contact::InitialGap>& gaps, const model::Contacts& contacts, bool all,
                                         Log& log);

}  // namespace mortise
