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
/// The same for axisymmetric models: of the plane motions of their subdomains only that along the axis is in the coarse problem,
/// so that many small ones cost products.
inline constexpr int usual_size_of_rings = 20000;

struct Options {
  std::string method = "metis";               ///< metis | grid (blocks only)
  std::optional<int> unknowns_per_subdomain;  ///< aim, before bodies are rounded to whole subdomains
  std::optional<int> subdomains;  ///< total instead of the aim above (at most, where parts have copies); neither: usual_size
  std::map<std::string, std::array<int, 3>> counts;  ///< grid: subdomains along each axis of each block
  int subdomains_per_cluster = 1;                    ///< about so many, of hybrid TFETI; 1: TFETI
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::partition
