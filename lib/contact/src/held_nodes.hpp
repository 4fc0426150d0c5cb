// What supports hold at the nodes of a side, and what they leave free there.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"

namespace mortise::contact {

/// The supports of all ranks, those of a node on rank node % ranks.
class HeldDirectory {
 public:
  /// `held` and `inclined` of this rank. Collective.
  HeldDirectory(std::span<const constraint::Held> held, std::span<const constraint::Inclined> inclined, const Communicator& comm);

 private:
  friend class HeldNodes;
  std::vector<constraint::Held> held_;
  std::vector<constraint::Inclined> inclined_;
};

/// The supports at the nodes of a side.
class HeldNodes {
 public:
  /// `nodes` are those that this rank asks about. Collective.
  HeldNodes(const HeldDirectory& directory, const std::vector<Global>& nodes, const Communicator& comm);

  /// Null where the component is free.
  const constraint::Held* find(Global node, int component) const;
  /// The directions that are held there and are no axes.
  std::span<const constraint::Inclined> inclined(Global node) const;

 private:
  std::vector<constraint::Held> held_;
  std::vector<constraint::Inclined> inclined_;
};

Point along(const constraint::Inclined& inclined);

/// The frame of a place: the tangents that supports leave free; nothing if the normal itself is held.
struct Directions {
  bool free_normal = true;
  std::vector<Point> tangents;
};
Directions directions(const Point& normal, const std::array<bool, 3>& held, std::span<const constraint::Inclined> inclined,
                      int dimension);

}  // namespace mortise::contact
