// Subdomains that are copies of each other, found by comparison: they can share a stiffness matrix and its factorization.
#pragma once

#include <vector>

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// For each subdomain of this rank the first one of this rank with the same cells (in the same local numbering), the same points
/// up to a translation, to 1e-10 of its size, and the same `kind` (one number a subdomain: whatever else must agree, such as the
/// material); its own index if there is none before it.
std::vector<std::size_t> congruent(const std::vector<Subdomain>& subdomains, const std::vector<int>& kind);

}  // namespace mortise::partition
