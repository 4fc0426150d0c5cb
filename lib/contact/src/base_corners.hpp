// Corners of the primary side inside secondary faces: where a body stands on its corner.
//
// Statics wants a multiplier at each: the forces that a base can pass on have their resultant between the points of its
// multipliers. A face that holds a corner gets a function that belongs to this point, with a row of its own: joined with the
// other functions of a node it would act somewhere between their points, which cuts the corner off.
#pragma once

#include <span>
#include <vector>

#include "covered_basis.hpp"
#include "side.hpp"

namespace mortise::contact {

/// Of each node of a side whether the side's border has a corner there: its facets enclose less than 150 degrees.
std::vector<char> sharp_nodes(const Side& side);

/// The corners of what a face's covered parts span that are among the places of `sharp` nodes of the primary side. `nodes`: of
/// the face, in its plane; corners at these are none, since nodes have rows. Ascending by node.
std::vector<BaseCorner> base_corners(std::span<const Plane> nodes, std::span<const CoveredPart> parts,
                                     std::span<const BaseCorner> sharp);

/// The node of a face of this type that stands for a place of it in the output: the nearest, of the ends of an edge that the
/// place lies on if it does, which the faces on both sides of the edge then agree on. `nodes`: in its plane, `id`: their numbers.
std::size_t node_beside(mesh::CellType type, std::span<const Plane> nodes, std::span<const Global> id, const Plane& at);

}  // namespace mortise::contact
