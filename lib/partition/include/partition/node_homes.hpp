// Where what ranks know of a node meets: on the first rank that has a copy of it. What concerns nodes of one rank alone is not
// sent anywhere.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "partition/node_directory.hpp"

namespace mortise::partition {

/// Does not change.
class NodeHomes {
 public:
  /// Knows the nodes on the surfaces of this rank's subdomains, and `others`, of any ranks, which may come more than once. Refers
  /// to `interface`. Collective.
  NodeHomes(const Decomposition& decomposition, const Interface& interface, const NodeDirectory& directory,
            std::span<const Global> others, const Communicator& comm);

  /// The rank; this one for a node that it does not know, which is inside of a subdomain. The same on every rank that knows it.
  std::size_t operator()(Global node) const;
  /// Of a node on the surface of one of this rank's subdomains its copies, ascending by subdomain; none for others. Weights are 0
  /// where there is one copy.
  std::vector<Copy> copies(Global node) const;

 private:
  struct Known {
    int rank;
    std::span<const Copy> shared = {};  ///< in the interface
    Global subdomain = -1;              ///< which has the only copy
    Local node = 0;                     ///< there
  };
  std::size_t here_;
  std::unordered_map<Global, Known> known_;
};

}  // namespace mortise::partition
