// Which rank gets which subdomains, and subdomains as bytes, for their way there.
#pragma once

#include <vector>

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// Contiguous ranges of subdomains, whole clusters, with about the same sum of weights for each rank; as Decomposition::first.
std::vector<Global> deal(const std::vector<long long>& weight, const std::vector<Global>& clusters, int ranks);

void pack(const Subdomain& subdomain, std::vector<char>& bytes);
std::vector<Subdomain> unpack(const std::vector<char>& bytes);

}  // namespace mortise::partition
