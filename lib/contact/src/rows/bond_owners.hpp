// Which of several bonds a secondary node belongs to.
//
// A body that is bonded to two others round their common edge would tie these to each other at each of its own nodes there, as
// stiffly as these are close, besides what ties them otherwise. As the mortar method has it where multipliers meet, all but one
// of the bonds do without [Wohlmuth, Discretization methods and iterative solvers based on domain decomposition, Springer
// (2001)]. Where faces match, rows tie pairs of nodes, and agree with each other; but those of a preloaded bond, whose sides
// part, agree with no others, and give way to them. Where nothing else ties the others, all bonds stay.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "integrals/cut_faces.hpp"
#include "search/opposite.hpp"
#include "surface/side.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// A node of one of the sides of a bond, there where they can meet.
struct NodeOfBond {
  Global node;
  int bond = 0;
};

/// A secondary node that a bond covers some of the faces round.
struct CoveredNode {
  Global node;
  int bond = 0;
  bool matches = false;                            ///< see on_matching_faces()
  double cover = 0;                                ///< see ContactNodes
  std::array<Global, 4> opposite{-1, -1, -1, -1};  ///< corners of a facet between which what lies opposite is
  bool cyclic = false;                             ///< the bond ties cuts of a sector
  bool preloaded = false;                          ///< the bond is a pretension section
};

/// The nodes that belong to another bond than `bond`: one that covers more of what is round them, the first of several. Both
/// lists are of this rank's nodes by number, ascending; see by_node(). Collective.
std::vector<NodeOfBond> nodes_of_others(const std::vector<CoveredNode>& covered, const std::vector<NodeOfBond>& sides,
                                        const Communicator& comm);

/// Of each surface node whether all nodes of the covered faces round it lie opposite nodes. `own`: of each node of the side
/// whether it is this rank's, which then knows all faces round it. Collective.
std::vector<char> on_matching_faces(const Side& secondary, const SurfaceNodes& surface_nodes, CutFaces& faces, Rays& rays,
                                    std::span<const char> own, const Communicator& comm);

}  // namespace mortise::contact
