// Which surface nodes of a secondary side carry multipliers: those that are covered enough, and not left out of a bond.
#pragma once

#include <span>
#include <vector>

#include "cut_faces.hpp"
#include "supported_nodes.hpp"

namespace mortise::contact {

/// A surface node covered by less than this part of its surroundings gets no multiplier.
inline constexpr double least_cover = 0.01;

/// Of each surface node.
struct ContactNodes {
  std::vector<Directions> directions;
  std::vector<double> covered;     ///< the area
  std::vector<double> cover;       ///< its part of all
  std::vector<char> kept;          ///< carries a multiplier
  std::vector<char> stranded;      ///< its faces have no surface node that supports and seams leave free
  std::vector<char> held_through;  ///< supports hold a tangent at all nodes of one of its faces
  std::vector<char> freed;         ///< its row keeps what supports hold of the secondary side
};

/// `faces` in pieces, with their integrals. `met`: of each surface node whether the primary side lies opposite; of use in a bond.
/// Nodes past its border leave their multipliers to the others of their faces: with their own the bond would hold whole faces,
/// and be as wide as those. Unless what is left holds no whole facet there, as on a strip with a single row of nodes.
/// `seams_end`: of each surface node whether a bonded seam ends there at a contact: both sides of the seam have rows of that
/// contact, each of which says what the other and the seam say: pressures that nothing shares out. As the mortar method does
/// where multipliers meet, the seam has none there. `dimension`: 2 or 3.
ContactNodes choose_contact_nodes(const Side& secondary, const SurfaceNodes& surface_nodes, CutFaces& faces,
                                  const SupportedNodes& supports, std::span<const char> seams_end, std::span<const char> met,
                                  bool bonded, int dimension);

}  // namespace mortise::contact
