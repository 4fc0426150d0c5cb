// Normals in plane models where an arc runs into one of another radius.
#pragma once

#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// In plane models, the normals of surface nodes between two arcs. With the nodes a1, a2 to one side of a node and b1, b2 to the
/// other, as vectors from it, the tangents there of the circles through it and two of them are a1 / a1^2 - a2 / a2^2 and so on
/// (inversion turns a circle through the origin into a line). Where those of both sides agree, but that of a1 and b1 differs from
/// them by more than a tenth of the angle between the two facets, and the curvature hardly changes on either side, it jumps, and
/// the tangent is theirs.
void take_normals_between_arcs(const Side& side, SurfaceNodes& surface_nodes);

}  // namespace mortise::contact
