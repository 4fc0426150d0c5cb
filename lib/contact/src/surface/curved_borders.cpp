#include "surface/curved_borders.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::contact {

bool is_kink_of_curved(double curved, double corners, const FaceEdges::Around& first, const FaceEdges::Around& last)
{
  constexpr double of_corners = 0.5, of_next = 0.4;
  constexpr double less_of_corners = 0.25, little_of_others = 0.1;  // where the faces behind are known, too
  constexpr double straight = 0.05;                                 // faces turn by what their corners do
  const double turn = std::abs(curved), part = turn / std::max({std::abs(corners), first.corners, last.corners});
  if (!first.curved || !last.curved || turn <= least_kink) return false;
  const double next = std::max(first.next, last.next), beyond = std::max(first.beyond, last.beyond);
  const double around = std::max(next, beyond);
  if (first.any_next && last.any_next)
    return (part > of_corners && next < of_next * turn) ||
           (first.any_beyond && last.any_beyond && part > less_of_corners && around < little_of_others * turn);
  // One side is a single face, to a border or another kink, and the other side tells. Of faces that are flat corners tell more.
  const bool flat = std::abs(curved - corners) < straight * std::abs(corners);
  return (first.any_beyond || last.any_beyond) && !flat && part > of_corners && around < little_of_others * turn;
}

CurvedBorders::CurvedBorders(const Side& side) : all_(side)
{
  std::vector<Edge> all;
  for (std::size_t f = 0; f < all_.faces().size(); ++f) {
    const auto& nodes = all_.faces()[f].nodes;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Local a = nodes[k], b = nodes.size() == 2 ? a : nodes[(k + 1) % nodes.size()];
      all.push_back({f, std::min(a, b), std::max(a, b), {}});
    }
  }
  const auto ends = [](const Edge& edge) { return std::pair(edge.a, edge.b); };
  std::ranges::sort(all, {}, ends);
  for (std::size_t e = 0; e < all.size(); ++e) {
    const bool shared = (e > 0 && ends(all[e - 1]) == ends(all[e])) || (e + 1 < all.size() && ends(all[e + 1]) == ends(all[e]));
    if (shared) continue;
    all[e].parts = all_.facet_edges(all[e].face, all[e].a, all[e].b);
    edges_.push_back(std::move(all[e]));
  }
}

bool CurvedBorders::meets_image_at_kink(const Edge& edge, const Point& normal) const
{
  const auto& face = all_.faces()[edge.face];
  const auto frame = all_.frame_between(edge.a, edge.b, face.normal - face.normal.dot(normal) * normal, normal);
  const auto curved = all_.slope_of_curved(edge.face, edge.a, edge.b, frame);
  const bool beyond = (face.centre - frame.middle).dot(normal) > 0;
  const double corners = FaceEdges::slope(face, frame, beyond ? normal : Point(-normal));
  const auto around = all_.around(edge.face, edge.a, edge.b, frame);
  return curved && is_kink_of_curved(2 * *curved, 2 * corners, around, around);
}

bool CurvedBorders::meets_at_kink(const Edge& edge, const CurvedBorders& other, const Edge& beyond) const
{
  const auto &here = all_.faces()[edge.face], &there = other.all_.faces()[beyond.face];
  const auto frame = all_.frame_between(edge.a, edge.b, here.normal + there.normal, there.centre - here.centre);
  const auto curved = all_.slope_of_curved(edge.face, edge.a, edge.b, frame);
  const auto curved_beyond = other.all_.slope_of_curved(beyond.face, beyond.a, beyond.b, frame);
  const double corners = FaceEdges::slope(there, frame, frame.away) - FaceEdges::slope(here, frame, frame.away);
  return curved && curved_beyond &&
         is_kink_of_curved(*curved + *curved_beyond, corners, all_.around(edge.face, edge.a, edge.b, frame),
                           other.all_.around(beyond.face, beyond.a, beyond.b, frame));
}

}  // namespace mortise::contact
