// Edges at which a plane or straight lines of a side run into an arc.
#pragma once

#include <vector>

#include "surface/face_edges.hpp"

namespace mortise::contact {

/// Edges that are no kinks (`parted`: of each edge whether it is one), but on one side alone two rows of faces lie in a plane; or
/// from one side to the other three faces of an arc turn by the same angle, and the face after them by half of it. Two rows in
/// which an S-curve turns by nothing, and bends the other way beyond, are none. Where faces of the plane are no wider than a
/// strip, as those of a cylinder or a cone between two of its straight lines, it is these lines that are straight, not what lies
/// across them. Ascending.
std::vector<TangentEdge> find_tangent_edges(const FaceEdges& edges, const std::vector<bool>& parted);

}  // namespace mortise::contact
