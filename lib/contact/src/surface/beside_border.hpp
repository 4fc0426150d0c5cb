// What a side looks like beside its border.
#pragma once

#include <utility>
#include <vector>

#include "surface/side.hpp"

namespace mortise::contact {

/// The facets that share nodes with those marked, and those that share nodes with them: normals ask for no others.
inline constexpr int rings_beyond = 2;
std::vector<char> facets_round(const mesh::Cells& facets, std::vector<char> nodes);

/// Of each node the length of the shortest edge of a facet there.
std::vector<double> shortest_edges(const Side& side);

/// At one node: facets, and its place in them.
using NodeCorners = std::vector<std::pair<std::size_t, std::size_t>>;
/// Of each node.
std::vector<NodeCorners> corners_of_nodes(const Side& side);

}  // namespace mortise::contact
