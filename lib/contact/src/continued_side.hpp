// What a side goes on in beyond its border: its image in a plane of symmetry, and what lies across a bond, in the other part of a
// body or in the next sector. So normals at the border are those of the whole surface, not those of one that ends there.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contact/mortar.hpp"
#include "mesh/instances.hpp"
#include "side.hpp"
#include "supported_nodes.hpp"
#include "surface_nodes.hpp"

namespace mortise::contact {

/// The faces of contacts next to bonds, of all ranks. Pretension sections, which part, are no such bonds.
class FacesAtBonds {
 public:
  /// Collective.
  FacesAtBonds(std::span<const Pair> pairs, fem::Kinematics kinematics, const Communicator& comm);

  /// Of each bond the nodes of a side that it holds together. Collective.
  std::vector<std::vector<Local>> held_together(const Side& side, const Communicator& comm) const;
  /// Appends to `whole`, to its points and facets alone, those that go on from a side without a kink: they have nodes in common
  /// with it, once they are moved across the bond. `alone`: the side's surface nodes, twice. Collective.
  void append_to(Side& whole, const Side& side, std::span<const SurfaceNodes> alone, const Communicator& comm) const;

 private:
  // A node on the secondary (1) or the primary (0) side of a bond.
  struct BondNode {
    Global node;
    int bond, side;
  };
  // The faces of contacts at one side of a bond, moved to where the other is, and which of their nodes are the bond's.
  struct Moved {
    Side faces;
    std::vector<char> in_bond;
    std::array<SurfaceNodes, 2> alone;  // see alone_of()
  };
  // At one node: facets, and its place in them.
  using Corners = std::vector<std::pair<std::size_t, std::size_t>>;
  static bool go_on(const Side& side, std::span<const SurfaceNodes> alone, const Corners& corners, const Moved& beyond,
                    const Corners& corners_beyond);


  std::vector<BondNode> nodes_;                // this rank's by number, see by_node()
  std::vector<std::array<Moved, 2>> at_bond_;  // by pair and side
};

/// The surface nodes of a side, with the normals that they have on what it goes on in: across bonds, and beyond planes of
/// symmetry. A plane is one if edges of the border lie in it, and supports hold their nodes along its normal. The side ends all
/// the same where the normals of both parts alone, or of the side alone and of its image, say that there is a kink. Collective.
SurfaceNodes find_surface_nodes(const Side& side, const SupportedNodes& supports, const FacesAtBonds& at_bonds,
                                const Communicator& comm);

}  // namespace mortise::contact
