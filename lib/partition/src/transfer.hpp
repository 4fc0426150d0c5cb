// Subdomains as bytes, for their way from rank 0 to their rank.
#pragma once

#include <vector>

#include "partition/decomposition.hpp"

namespace mortise::partition {

void pack(const Subdomain& subdomain, std::vector<char>& bytes);
std::vector<Subdomain> unpack(const std::vector<char>& bytes);

}  // namespace mortise::partition
