// What presses together: nodes of contacts' sides that pressed faces join, over all ranks.
#pragma once

#include <compare>
#include <optional>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "contact/state.hpp"

namespace mortise::post {

/// A node of a contact's secondary side.
struct SideNode {
  long long contact;
  Global node;
  auto operator<=>(const SideNode&) const = default;
};

/// For each rank those that it looks after, each once, ascending.
std::vector<std::vector<SideNode>> by_their_ranks(std::vector<SideNode> nodes, const Communicator& comm);

/// The patches that faces with pressed nodes make up, where they have nodes in common: one that is open among pressed ones, as
/// beside the corner of a punch, parts nothing. Bonded contacts have none.
///
/// A rank joins what its own faces join. Where ranks meet, they tell which of their parts have nodes in common: parts and the
/// pairs that meet are all that every rank holds.
class Patches {
 public:
  /// `asked`: nodes that this rank will ask for, beside those of its pressed faces. Collective.
  Patches(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs, std::vector<SideNode> asked,
          const Communicator& comm);

  /// The contact of each patch, ascending; the same on every rank.
  const std::vector<int>& contacts() const { return contact_; }
  /// The patch of a node of this rank's pressed faces, or one that was asked for; none if no face with a pressed node has it.
  std::optional<std::size_t> of(const SideNode& node) const;

 private:
  std::vector<int> contact_;
  std::vector<SideNode> nodes_;
  std::vector<std::size_t> patch_;
};

}  // namespace mortise::post
