// Faces that span so much of a turn that the mesh hardly says what shape they have.
#pragma once

#include "contact/fit.hpp"
#include "search/opposite.hpp"
#include "surface/side.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// Notes the turns of the secondary facets all of whose corners touch, and of those opposite a corner that touches them, or would
/// if they were flats: of each what the smooth surface behind it turns by from its middle to a corner, twice; or, of a flat on a
/// round surface, what this turns by between the places opposite the ends of an edge, and the facet's own side does not. Not
/// those of flats on flats.
void note_turns(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary, const SurfaceNodes& primary_nodes,
                Rays& rays, InitialGap& all);

}  // namespace mortise::contact
