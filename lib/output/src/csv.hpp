// Entries of tables with commas.
#pragma once

#include <fmt/format.h>

#include <string>

#include "model/deck.hpp"

namespace mortise::output {

/// A name, in quotes where it needs them.
inline std::string quoted(const std::string& name)
{
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string result = "\"";
  for (const char c : name) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

/// The first columns of a table of many states, and their entries; "" without load steps.
inline std::string header_of_states(const model::Deck& deck)
{
  return deck.steps.empty() ? "" : "step,time,";
}
inline std::string entries_of_state(const model::LoadState& acts)
{
  return acts.step.empty() ? "" : fmt::format("{},{},", quoted(acts.step), acts.time);
}

}  // namespace mortise::output
