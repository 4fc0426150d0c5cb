// The deck's section `decomposition`.
#pragma once

#include <array>
#include <map>
#include <string>

#include "deck/description.hpp"

namespace mortise::partition {

struct Options {
  std::string method = "metis";                      ///< metis | grid (blocks only)
  int unknowns_per_subdomain = 4000;                 ///< aim, before bodies are rounded to whole subdomains
  int subdomains = 0;                                ///< total instead of the aim above; 0: not given
  std::map<std::string, std::array<int, 3>> counts;  ///< grid: subdomains an axis of each block
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::partition
