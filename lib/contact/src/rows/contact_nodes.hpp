// Which surface nodes of a secondary side carry multipliers: those that are covered enough, and not left out of a bond.
#pragma once

#include <optional>
#include <vector>

#include "integrals/cut_faces.hpp"
#include "rows/supported_nodes.hpp"

namespace mortise::contact {

/// A surface node covered by less than this part of its surroundings gets no multiplier.
inline constexpr double least_cover = 0.01;

/// Of each surface node.
struct ContactNodes {
  std::vector<Directions> directions;
  std::vector<double> covered;  ///< the area
  std::vector<double> cover;    ///< its part of all
  std::vector<char> kept;       ///< carries a multiplier
  std::vector<char> stranded;   ///< its faces have no surface node that supports and seams leave free
  std::vector<char> shared;     ///< is covered, but leaves its multiplier to the others of its faces
  std::vector<char> freed;      ///< its row keeps what supports hold of the secondary side
};

/// What a bond knows of each surface node besides.
struct BondedNodes {
  /// The rows of others say what its own would say; as the mortar method does where multipliers meet, the bond has none there.
  /// Either a contact ends there on both sides of the bond: not past the border of the primary side, where multipliers stand
  /// inside, at places that the contact knows nothing of. Or the node belongs to another bond, see bond_owners.hpp.
  std::vector<char> left_to_others;
  /// The primary side lies opposite. Nodes past its border leave their multipliers to the others of their faces: with their own
  /// the bond would hold whole faces, and be as wide as those. Unless what is left holds no whole face there, as on a strip with
  /// a single row of nodes. Empty where sides end together, as cuts of sectors do.
  std::vector<char> met;
};

/// Of each surface node whether it is a node of the primary side as well, as at the tip of a slit; but none of a face that has no
/// other nodes, for nobody is there to take over.
std::vector<char> nodes_of_both_sides(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary);

/// The part of the faces round each of `count` surface nodes that is covered.
std::vector<double> cover_of_nodes(CutFaces& faces, std::size_t count);

/// `faces` in pieces, with their integrals. `one_node`: nodes_of_both_sides(), which have no multiplier, since they cannot leave
/// themselves; all zero of obstacles and cuts of sectors. `primary_prescribed`: of each surface node whether supports hold the
/// primary side along the normal where multipliers stand; all of cuts of sectors. `bond`: none of a contact. `dimension`: 2 or 3.
ContactNodes choose_contact_nodes(const Side& secondary, const SurfaceNodes& surface_nodes, CutFaces& faces,
                                  const SupportedNodes& supports, const std::vector<char>& one_node,
                                  const std::vector<char>& primary_prescribed, const std::optional<BondedNodes>& bond,
                                  int dimension);

}  // namespace mortise::contact
