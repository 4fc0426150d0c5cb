#include "edges.hpp"

#include <algorithm>
#include <tuple>

namespace mortise::contact {

namespace {

// Sine of the angle from which there is an edge between two faces.
constexpr double least_bend = 0.05;

}  // namespace

Edges edges_at(const Side& side, const SurfaceNodes& surface_nodes)
{
  Edges result{std::vector<Few<Point, 3>>(surface_nodes.all.size()), std::vector<bool>(surface_nodes.all.size(), false)};
  std::vector<Point> centre(surface_nodes.all.size(), Point::Zero());  // of the facets round each, from the node
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto face = side.geometry(f);
    for (std::size_t k = 0; k < face.nodes.size(); ++k)
      centre[static_cast<std::size_t>(surface_nodes.of_corner[static_cast<std::size_t>(side.facets.offset[f]) + k])] +=
          (face.centre() - face.nodes[k]).normalized();
  }
  // Surface nodes of a node follow each other.
  for (std::size_t begin = 0, end = 0; begin < centre.size(); begin = end) {
    while (end < centre.size() && surface_nodes.all[end].node == surface_nodes.all[begin].node) ++end;
    for (std::size_t a = begin; a < end; ++a)
      for (std::size_t b = begin; b < end; ++b) {
        if (a == b) continue;
        const double in_front = surface_nodes.all[a].normal.dot(centre[b].normalized());
        if (in_front > least_bend && result.concave[a].size() < 3) result.concave[a].push_back(surface_nodes.all[b].normal);
        if (in_front < -least_bend) result.convex[a] = true;
      }
  }
  return result;
}

Ridges find_ridges(const Side& side, const SurfaceNodes& surface_nodes)
{
  struct HalfEdge {
    FacetEdge ends;
    std::size_t facet;
    std::array<std::size_t, 2> corners;  // of the facet, at its ends
  };
  std::vector<HalfEdge> edges;
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto nodes = side.facets[f];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const std::size_t l = nodes.size() == 2 ? k : (k + 1) % nodes.size();
      if (nodes[k] <= nodes[l])
        edges.push_back({{nodes[k], nodes[l]}, f, {k, l}});
      else
        edges.push_back({{nodes[l], nodes[k]}, f, {l, k}});
    }
  }
  std::ranges::sort(edges, {}, [](const HalfEdge& e) { return std::tuple(e.ends, e.facet); });

  Ridges result;
  std::vector<std::pair<Local, Local>> of_facets;  // a facet and its ridge
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const HalfEdge &first = edges[i], &last = edges[i + 1];
    if (first.ends != last.ends) continue;
    const auto node_of = [&](const HalfEdge& e, std::size_t end) {
      return surface_nodes.of_corner[static_cast<std::size_t>(side.facets.offset[e.facet]) + e.corners[end]];
    };
    if (node_of(first, 0) == node_of(last, 0) && node_of(first, 1) == node_of(last, 1)) continue;
    const auto normal_of = [&](const HalfEdge& e) -> Point {
      return (surface_nodes.normal(side, e.facet, e.corners[0]) + surface_nodes.normal(side, e.facet, e.corners[1])).normalized();
    };
    Ridge ridge{first.ends, {normal_of(first), normal_of(last)}, Point::Zero()};
    const Point& a = side.points[static_cast<std::size_t>(first.ends[0])];
    const Point edge = side.points[static_cast<std::size_t>(first.ends[1])] - a, along = edge.isZero(0) ? edge : edge.normalized();
    const Point normal = (ridge.normals[0] + ridge.normals[1]).normalized();
    const Point way = side.geometry(last.facet).centre() - side.geometry(first.facet).centre();
    if (ridge.normals[0].dot((side.geometry(last.facet).centre() - a).normalized()) > -least_bend) continue;
    ridge.across = (way - way.dot(along) * along - way.dot(normal) * normal).normalized();
    for (const std::size_t facet : {first.facet, last.facet})
      of_facets.emplace_back(static_cast<Local>(facet), static_cast<Local>(result.all.size()));
    result.all.push_back(ridge);
  }
  std::ranges::sort(of_facets);
  result.offset.assign(side.facets.size() + 1, 0);
  for (const auto& [facet, ridge] : of_facets) {
    ++result.offset[static_cast<std::size_t>(facet) + 1];
    result.of.push_back(ridge);
  }
  for (std::size_t f = 0; f < side.facets.size(); ++f) result.offset[f + 1] += result.offset[f];
  return result;
}

}  // namespace mortise::contact
