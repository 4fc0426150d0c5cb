// Nodes that hardly any of the other side covers.
//
// Such a node bears what presses on a strip much narrower than a face, where the points of two rows lie close together. Their
// forces are right together; which of them bears more says nothing, and the force of one over the area of a sliver is no
// pressure. So it gives force and area to its neighbours with more cover, by their areas, these to theirs, and so on; and it
// takes the mean of what they have then, as nodes without rows do, for which their neighbours' rows stand in [cells that are
// hardly cut are joined with their neighbours: Badia, Verdugo and Martin, CMAME 336 (2018); rows stay apart here, since bodies
// stand on the points of the outermost].
#pragma once

#include <array>
#include <vector>

#include "state/node_state.hpp"

namespace mortise::contact {

class NarrowNodes {
 public:
  /// Collective.
  NarrowNodes(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm);

  /// Forces and areas pass to the neighbours. Collective, as the others, which it comes before.
  void give(std::vector<NodeState>& nodes);
  /// And their pressures and tractions back.
  void take_pressures(std::vector<NodeState>& nodes);
  void take_recovered(std::vector<NodeState>& nodes);
  /// And what is closed: a node is that takes force from one that is, or part of its pressure from such nodes.
  void take_closed(std::vector<NodeState>& nodes);

 private:
  // How narrow a node can be.
  static constexpr std::size_t bands = 4;

  // What passes between a narrow node and one of its neighbours with more cover; lives on the rank of `node`, one of the two.
  struct Given {
    Global node;
    int contact, side;
    Global other;
    int other_side;
    double part;                 // of what the narrow one has
    double area, force, closed;  // that pass
    std::array<double, 3> traction;
    double gap;  // of the wide one
    int status;
  };
  static bool ascending(const Given& a, const Given& b);
  static NodeState& state_of(std::vector<NodeState>& nodes, const Given& given);
  static std::size_t band_of(double cover);
  std::vector<Given> neighbours(const std::vector<NodeState>& nodes, std::span<const Pair> pairs) const;
  std::vector<Given> sent_across(std::vector<Given> given) const;
  template <class Take, class Clear, class Add>
  void take(std::vector<NodeState>& nodes, const Take& value, const Clear& clear, const Add& add);

  const Communicator& comm_;
  std::array<std::vector<Given>, bands + 1> given_;     // of the narrow nodes of each band, on their ranks
  std::array<std::vector<Given>, bands + 1> received_;  // the same on those of their neighbours
  std::array<bool, bands + 1> any_{};                   // on any rank
};

}  // namespace mortise::contact
