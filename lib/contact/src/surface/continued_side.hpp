// What a side goes on in beyond its border: its image in a plane of symmetry, and what lies across a bond, in the other part of a
// body or in the next sector. So normals at the border are those of the whole surface, not those of one that ends there.
#pragma once

#include <span>

#include "rows/supported_nodes.hpp"
#include "surface/faces_at_bonds.hpp"
#include "surface/side.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// The surface nodes of a side, with the normals that they have on what it goes on in: across bonds, and beyond planes of
/// symmetry. A plane is one if edges of the border lie in it, and supports hold their nodes along its normal. The side ends all
/// the same where the normals of both parts alone, or of the side alone and of its image, say that there is a kink. `nodes`: as
/// of FacesAtBonds::nodes_of().
SurfaceNodes find_surface_nodes(const Side& side, const SupportedNodes& supports, const FacesAtBonds& at_bonds,
                                std::span<const FacesAtBonds::AtBond> nodes);

}  // namespace mortise::contact
