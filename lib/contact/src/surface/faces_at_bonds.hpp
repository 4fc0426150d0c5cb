// What lies across a bond from the side of a contact: the other part of a body, or the next sector.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contact/mortar.hpp"
#include "surface/beside_border.hpp"
#include "surface/curved_borders.hpp"

namespace mortise::contact {

/// The faces of contacts next to bonds, of all ranks. Pretension sections, which part, are no such bonds.
class FacesAtBonds {
 public:
  /// Nodes of a side that are those of a bond, of its secondary (1) or its primary (0) side.
  struct AtBond {
    int bond, side;
    std::vector<Local> nodes;
  };

  /// Collective.
  FacesAtBonds(std::span<const Pair> pairs, fem::Kinematics kinematics, const Communicator& comm);

  /// Collective.
  std::vector<AtBond> nodes_of(const Side& side, const Communicator& comm) const;
  /// Appends to `whole`, to its points and facets alone, those that go on from a side without a kink: they have nodes in common
  /// with it, once they are moved across the bond. `alone`: the side's surface nodes, twice. `at_bonds`: as of nodes_of().
  void append_to(Side& whole, const Side& side, std::span<const SurfaceNodes> alone, std::span<const AtBond> at_bonds) const;

 private:
  struct BondNode {
    Global node;
    int bond, side;
  };
  // A face of a contact next to a bond, and a node of it, on their way.
  struct SentFaceAtBond {
    int bond, side;
    SentFace face;
  };
  struct SentNodeAtBond {
    int bond, side;
    SentNode node;
    int in_bond;
  };
  // The faces of contacts at one side of a bond, moved to where the other is, and which of their nodes are the bond's.
  struct Moved {
    Side faces;
    std::vector<char> in_bond;
    std::array<SurfaceNodes, 2> alone;  // see alone_of()
  };
  // This rank's faces within two rings of the bonds' nodes. Collective.
  void find_faces(std::span<const mesh::Surface* const> surfaces, std::vector<SentFaceAtBond>& faces,
                  std::vector<SentNodeAtBond>& nodes, const Communicator& comm) const;
  // A node of a side and one beyond in the same place, where the side goes on.
  struct Met {
    std::size_t beyond, here;
    double distance;
    GoesOn said;
  };
  static GoesOn go_on(const Side& side, std::span<const SurfaceNodes> alone, const NodeCorners& corners, const Moved& beyond,
                      const NodeCorners& corners_beyond);
  static void deny_at_kinks_of_curved(const CurvedBorders& here, const Side& beyond, std::span<const Met> met,
                                      std::span<GoesOn> votes);
  // A side, and what all bonds ask of it.
  struct Beside {
    const Side& side;
    std::span<const SurfaceNodes> alone;
    std::vector<NodeCorners> corners;
    CurvedBorders borders;
  };
  static std::vector<Met> meet(const Beside& beside, std::span<const Local> nodes, const Moved& beyond);

  std::vector<BondNode> nodes_;                // this rank's by number, see by_node()
  std::vector<std::array<Moved, 2>> at_bond_;  // by pair and side
};

/// Of each bond the nodes of a side that it holds together, be they on one side of it or on both.
std::vector<std::vector<Local>> tied_together(std::span<const FacesAtBonds::AtBond> nodes);

}  // namespace mortise::contact
