#include "surface/beside_border.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pairing/skin.hpp"

namespace mortise::contact {

std::vector<char> facets_round(const mesh::Cells& facets, std::vector<char> nodes)
{
  std::vector<char> result(facets.size(), 0);
  for (int ring = 0; ring < rings_beyond; ++ring) {
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const Local n : facets[f])
        if (nodes[static_cast<std::size_t>(n)]) result[f] = 1;
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const Local n : facets[f])
        if (result[f]) nodes[static_cast<std::size_t>(n)] = 1;
  }
  return result;
}

std::vector<double> shortest_edges(const Side& side)
{
  std::vector<double> result(side.points.size(), std::numeric_limits<double>::max());
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto nodes = side.facets[f];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto a = static_cast<std::size_t>(nodes[k]), b = static_cast<std::size_t>(nodes[(k + 1) % nodes.size()]);
      const double length = (side.points[a] - side.points[b]).norm();
      result[a] = std::min(result[a], length);
      result[b] = std::min(result[b], length);
    }
  }
  return result;
}

std::vector<NodeCorners> corners_of_nodes(const Side& side)
{
  std::vector<NodeCorners> result(side.points.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    for (std::size_t k = 0; k < side.facets[f].size(); ++k)
      result[static_cast<std::size_t>(side.facets[f][k])].emplace_back(f, k);
  return result;
}

std::array<SurfaceNodes, 2> alone_of(const Side& side)
{
  return {surface_nodes_of_facets(side), surface_nodes_of_facets(side, false)};
}

bool goes_on(const Point& face, const Point& alone, const Point& other_face, const Point& other_alone)
{
  // The normals of both sides alone at a border may differ by this part of what the faces there do: more is a kink. So is less
  // than minus that part, as at a groove beside a bump; but for what is far below, as of a flat bottom with steep ends, of whose
  // curvature the two rows of nodes beside the border say nothing.
  constexpr double of_a_kink = 0.5, of_steep_ends = 3;
  // And so is what is far above: faces that hardly turn make no kink, whatever a border says that few nodes determine.
  const Point faces = other_face - face, nodes = other_alone - alone;
  if (nodes.norm() < rounding || nodes.norm() > of_steep_ends * faces.norm()) return true;
  const double part = nodes.dot(faces) / faces.squaredNorm();
  return std::abs(part) <= of_a_kink;
}

void follow_neighbours(std::vector<FacetEdge> edges, std::vector<GoesOn>& nodes)
{
  const auto vote = [&](Local n) {
    const GoesOn said = nodes[static_cast<std::size_t>(n)];
    return said == GoesOn::yes ? 1 : said == GoesOn::no ? -1 : 0;
  };
  for (auto& [a, b] : edges)
    if (b < a) std::swap(a, b);
  std::ranges::sort(edges);
  const auto end = std::ranges::unique(edges).begin();
  std::vector<int> votes(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) votes[n] = vote(static_cast<Local>(n));
  for (auto edge = edges.begin(); edge != end; ++edge) {
    const auto [a, b] = *edge;
    if (a == b) continue;
    votes[static_cast<std::size_t>(a)] += vote(b);
    votes[static_cast<std::size_t>(b)] += vote(a);
  }
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (nodes[n] != GoesOn::not_asked && votes[n] != 0) nodes[n] = votes[n] > 0 ? GoesOn::yes : GoesOn::no;
}

void deny(std::span<const FacetEdge> parts, std::span<GoesOn> nodes)
{
  for (const FacetEdge& part : parts)
    for (const Local n : part)
      if (auto& said = nodes[static_cast<std::size_t>(n)]; said != GoesOn::not_asked) said = GoesOn::no;
}

}  // namespace mortise::contact
