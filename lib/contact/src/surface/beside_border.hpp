// What a side looks like beside its border, and whether another one goes on from it there.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "surface/side.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// The facets that share nodes with those marked, and those that share nodes with them: normals ask for no others.
inline constexpr int rings_beyond = 2;
std::vector<char> facets_round(const mesh::Cells& facets, std::vector<char> nodes);

/// Adds kinks and tangent edges of another side whose nodes are all here: `here` is a node, or less than 0.
template <class Here>
void append_kinks(Side& side, const Side& other, const Here& here)
{
  const auto ends = [&](const FacetEdge& edge) {
    const Local a = here(edge[0]), b = here(edge[1]);
    return FacetEdge{std::min(a, b), std::max(a, b)};
  };
  const std::size_t kinks = other.kinks.size(), tangent = other.tangent_edges.size();  // they may be the same
  for (std::size_t e = 0; e < kinks; ++e)
    if (const auto edge = ends(other.kinks[e]); edge[0] >= 0) side.kinks.push_back(edge);
  for (std::size_t e = 0; e < tangent; ++e) {
    TangentEdge tangential = other.tangent_edges[e];
    tangential.edge = ends(tangential.edge);
    bool all_here = tangential.edge[0] >= 0;
    for (auto& line : tangential.beyond)
      for (Local& n : line) all_here = (n = here(n)) >= 0 && all_here;
    if (all_here) side.tangent_edges.push_back(tangential);
  }
}

/// Of each node the length of the shortest edge of a facet there.
std::vector<double> shortest_edges(const Side& side);

/// At one node: facets, and its place in them.
using NodeCorners = std::vector<std::pair<std::size_t, std::size_t>>;
/// Of each node.
std::vector<NodeCorners> corners_of_nodes(const Side& side);

/// The surface nodes of a side by itself, without `of_node`: with the normals of the surface through the nodes, and with those
/// that continue the curvature of the faces beside the border, of which one may be right where the other is not.
std::array<SurfaceNodes, 2> alone_of(const Side& side);

/// Whether there is no kink where faces with these normals meet, and the normals of each side alone are these. All are unit.
bool goes_on(const Point& face, const Point& alone, const Point& other_face, const Point& other_alone);

/// What a border's nodes say, of which each has a vote, as have those at the other ends of its edges; where votes are equal, its
/// own counts. A side that goes on at some nodes alone would have slits in it.
enum class GoesOn : char { not_asked, no, yes };
void follow_neighbours(std::vector<FacetEdge> edges, std::vector<GoesOn>& nodes);
/// Of the nodes of an edge, or of its parts, those that were asked say no.
void deny(std::span<const FacetEdge> parts, std::span<GoesOn> nodes);

}  // namespace mortise::contact
