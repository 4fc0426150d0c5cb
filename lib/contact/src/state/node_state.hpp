// What the points of contacts are, gathered on the ranks of their nodes.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <vector>

#include "contact/state.hpp"

namespace mortise::contact {

/// A point at a node of a contact; at a kink there are several, in the order of their normals. Plain bytes. Lives on the node's
/// own rank, see by_node().
struct NodeState {
  Global node;
  int contact, side, status;                     ///< side: which of the node's points
  double area, cover, force, gap;                ///< force: a pressure once it is divided by the area
  std::array<double, 3> normal, traction, slip;  ///< traction is a force at first
  double recovered = 0;                          ///< pressure
  double closed = 0;                             ///< part of its area that counts as closed
  bool bare = false;                             ///< has no rows: shows what its neighbours have
};

/// Less of what presses at a place between nodes does not close a node.
inline constexpr double bears = 0.1;

/// Those of this rank's own nodes, ascending by node, contact and side. What presses on a corner of the primary side counts with
/// the node beside it. Collective.
std::vector<NodeState> meet(std::span<const ContactNodeState> states, std::span<const constraint::NodeWithoutRows> without_rows,
                            const Communicator& comm);
/// What the nodes of this rank's secondary sides are, ascending. Collective.
std::vector<NodeState> on_sides(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm);

/// All points at a node, of ascending ones.
template <class Nodes>
auto points_at(Nodes& nodes, int contact, Global node)
{
  NodeState wanted{};
  wanted.contact = contact;
  wanted.node = node;
  const auto [first, last] = std::equal_range(nodes.begin(), nodes.end(), wanted, [](const NodeState& a, const NodeState& b) {
    return std::tie(a.node, a.contact) < std::tie(b.node, b.contact);
  });
  return std::span(first, last);
}
/// That at a node of a face with this normal, or null; of a single point without a normal that one.
const NodeState* point_of(const std::vector<NodeState>& nodes, int contact, Global node, const Point& face_normal);

}  // namespace mortise::contact
