// The deck's section `decomposition`.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "deck/description.hpp"

namespace mortise::partition {

/// Unknowns of a subdomain where the deck says nothing.
inline constexpr int usual_size = 4000;

struct Options {
  std::string method = "metis";                      ///< metis | grid (blocks only)
  std::optional<int> unknowns_per_subdomain;         ///< aim, before bodies are rounded to whole subdomains
  std::optional<int> subdomains;                     ///< total instead of the aim above; neither: usual_size
  std::map<std::string, std::array<int, 3>> counts;  ///< grid: subdomains an axis of each block
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::partition
