// Edges at which a side turns by less than coarse curved sides do, and yet does not go on: of chamfers, bevels and grooves.
#pragma once

#include "surface/side.hpp"

namespace mortise::contact {

/// Sets `kinks` and `tangent_edges` (tangent_edges.hpp) of a side.
///
/// Kinks: the edges between facets of a side at which it has a kink, from node to node, the smaller first, ascending; in plane
/// models the nodes, twice. There the surfaces of second order through the corners of the faces on each side alone meet at an
/// angle that is more than 0.85 of this and of what they turn, together, between the middles of the two faces: on a smooth
/// surface it is nothing. Curved faces of second order turn by half of that angle themselves. And the two faces turn by so much
/// more than they do to the next ones. Where one side has a single row of faces, the surface of the other is continued over it,
/// if three rows tell that this is plane. Where there are three rows on both sides and corners turn by 2.5 times what they do to
/// any of these, 0.6 is enough. Edges that turn by more than about 40 degrees are kinks anyway and not named.
void find_kinks(Side& side);

/// Of both sides of a contact, each alone; and where an edge of one lies upon one of the other, if corners turn there by 2.1
/// times what they do to the next rows on one of the sides and by 1.5 times on the other, where rows end at edges that lie upon
/// others, and the faces beside it tell, see share_kinks(). Meshes of one smooth surface have edges in one place by chance alone,
/// or match, and then nothing tells.
void find_kinks(Side& secondary, Side& primary);

}  // namespace mortise::contact
