// Corners of a base inside secondary faces or on their edges: where a body stands on its corner.
//
// Statics wants a multiplier at each: the forces that a base can pass on have their resultant between the points of its
// multipliers. A base's corners are those of the secondary side, which are nodes, those of the primary side, and crossings of the
// two sides' borders. A face that holds a corner gets a function that belongs to this point, with a row of its own: joined with
// the other functions of a node it would act somewhere between their points, which cuts the corner off.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "integrals/covered_basis.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

/// Of each node of a side whether the side's border has a corner there: its facets enclose less than 150 degrees.
std::vector<char> sharp_nodes(const Side& side);

/// Of each facet of a side which of its edges, from corner k to the next, belong to the side's border: no other facet has them.
std::vector<std::array<bool, 4>> border_edges(const Side& side);

/// Where a border edge of each side, from a to b and from c to d, cross in the plane of the secondary face, with its facets on
/// their left and the primary ones on their right: a corner of what both have in common if that encloses less than 175 degrees.
std::optional<Plane> crossing(const Plane& a, const Plane& b, const Plane& c, const Plane& d);

/// The corners of what a face's covered parts span that are among the places of `sharp` nodes of the primary side and of
/// crossings, whose number is -1. `nodes`: of the face, in its plane; corners at these are none, since nodes have rows. Ascending
/// by number, crossings last, by their place.
std::vector<BaseCorner> base_corners(std::span<const Plane> nodes, std::span<const CoveredPart> parts,
                                     std::span<const BaseCorner> sharp);

/// The node of a face of this type that stands for a place of it in the output: the nearest, of the ends of an edge that the
/// place lies on if it does, which the faces on both sides of the edge then agree on. `nodes`: in its plane, `id`: their numbers.
std::size_t node_beside(mesh::CellType type, std::span<const Plane> nodes, std::span<const Global> id, const Plane& at);

}  // namespace mortise::contact
