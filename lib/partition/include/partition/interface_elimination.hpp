// What the factor of a whole body holds besides those of its subdomains: their interface, eliminated by nested dissection.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "partition/decomposition.hpp"
#include "partition/node_directory.hpp"

namespace mortise::partition {

/// Of L in a Cholesky factorization L L'.
struct FactorSize {
  double entries = 0;
  double operations = 0;  ///< multiplications: the sum of the squares of the columns' heights
};

/// For each body what eliminating the interface between its subdomains takes once their insides are eliminated. Nodes that the
/// same subdomains share are one vertex of a graph, in which every subdomain is a clique; METIS orders it. As large as the
/// coarse problem, whatever the mesh. The same on every rank and for every number of ranks. Collective.
std::vector<FactorSize> interface_elimination(const Decomposition& decomposition, const Interface& interface,
                                              const Communicator& comm);

}  // namespace mortise::partition
