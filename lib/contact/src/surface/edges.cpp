#include "surface/edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mortise::contact {

namespace {

// Sine of the angle from which there is an edge between two faces.
constexpr double least_bend = 0.05;

// An edge of one facet, the corners at its ends in their order; in plane models an end of it, twice.
struct HalfEdge {
  FacetEdge ends;
  std::size_t facet;
  std::array<std::size_t, 2> corners;
};

// Ascending by their ends.
std::vector<HalfEdge> half_edges(const Side& side)
{
  const auto each = [&](const auto& use) {
    for (std::size_t f = 0; f < side.facets.size(); ++f) {
      const auto nodes = side.facets[f];
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const std::size_t l = nodes.size() == 2 ? k : (k + 1) % nodes.size();
        if (nodes[k] <= nodes[l])
          use(HalfEdge{{nodes[k], nodes[l]}, f, {k, l}});
        else
          use(HalfEdge{{nodes[l], nodes[k]}, f, {l, k}});
      }
    }
  };
  // By their first ends, of which each has a few.
  std::vector<std::size_t> offset(side.points.size() + 1, 0);
  each([&](const HalfEdge& e) { ++offset[static_cast<std::size_t>(e.ends[0]) + 1]; });
  for (std::size_t n = 0; n + 1 < offset.size(); ++n) offset[n + 1] += offset[n];
  std::vector<HalfEdge> edges(offset.back());
  auto next = offset;
  each([&](const HalfEdge& e) { edges[next[static_cast<std::size_t>(e.ends[0])]++] = e; });
  for (std::size_t n = 0; n + 1 < offset.size(); ++n)
    std::ranges::sort(std::span(edges).subspan(offset[n], offset[n + 1] - offset[n]), {},
                      [](const HalfEdge& e) { return std::pair(e.ends[1], e.facet); });
  return edges;
}

Local surface_node_at(const Side& side, const SurfaceNodes& surface_nodes, const HalfEdge& edge, std::size_t end)
{
  return surface_nodes.of_corner[static_cast<std::size_t>(side.facets.offset[edge.facet]) + edge.corners[end]];
}

// Whether the side goes on beyond an edge of its border.
bool goes_on(const SurfaceNodes& surface_nodes, const HalfEdge& edge)
{
  return std::ranges::binary_search(surface_nodes.continued, edge.ends);
}

// Unit, or zero in plane models.
Point along(const Side& side, const HalfEdge& edge)
{
  const Point way = side.points[static_cast<std::size_t>(edge.ends[1])] - side.points[static_cast<std::size_t>(edge.ends[0])];
  return way.isZero(0) ? way : Point(way.normalized());
}

Point across(const Point& way, const Point& along, const Point& normal)
{
  return (way - way.dot(along) * along - way.dot(normal) * normal).normalized();
}

}  // namespace

Edges edges_at(const Side& side, const SurfaceNodes& surface_nodes)
{
  Edges result{std::vector<Few<Point, 3>>(surface_nodes.all.size()), std::vector<bool>(surface_nodes.all.size(), false),
               std::vector<Point>(surface_nodes.all.size(), Point::Zero())};
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
        if (std::abs(in_front) > least_bend && result.beside[a].size() < 3)
          result.beside[a].push_back(surface_nodes.all[b].normal);
        if (in_front < -least_bend) result.convex[a] = true;
      }
  }
  const auto edges = half_edges(side);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const HalfEdge& edge = edges[i];
    if ((i > 0 && edges[i - 1].ends == edge.ends) || (i + 1 < edges.size() && edges[i + 1].ends == edge.ends)) continue;
    if (goes_on(surface_nodes, edge)) continue;
    const Point to_border = side.points[static_cast<std::size_t>(edge.ends[0])] - side.geometry(edge.facet).centre();
    for (const std::size_t end : {0U, 1U}) {
      const auto p = static_cast<std::size_t>(surface_node_at(side, surface_nodes, edge, end));
      result.outward[p] += across(to_border, along(side, edge), surface_nodes.all[p].normal);
    }
  }
  for (auto& outward : result.outward)
    if (!outward.isZero(1e-9)) outward.normalize();
  return result;
}

double curvature_of(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet)
{
  const auto nodes = side.facets[facet];
  double result = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::size_t l = (k + 1) % nodes.size();
    const double length =
        (side.points[static_cast<std::size_t>(nodes[l])] - side.points[static_cast<std::size_t>(nodes[k])]).norm();
    result = std::max(result, (surface_nodes.normal(side, facet, l) - surface_nodes.normal(side, facet, k)).norm() / length);
  }
  return result;
}

Ridges find_ridges(const Side& side, const SurfaceNodes& surface_nodes)
{
  const auto edges = half_edges(side);
  const auto normal_of = [&](const HalfEdge& e) -> Point {
    return (surface_nodes.normal(side, e.facet, e.corners[0]) + surface_nodes.normal(side, e.facet, e.corners[1])).normalized();
  };
  Ridges result;
  std::vector<std::pair<Local, Local>> of_facets;  // a facet and its ridge
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const HalfEdge &first = edges[i], &last = i + 1 < edges.size() && edges[i + 1].ends == first.ends ? edges[i + 1] : first;
    const bool border = &first == &last;
    if (border && i > 0 && edges[i - 1].ends == first.ends) continue;
    if (border && goes_on(surface_nodes, first)) continue;
    const auto one_node = [&](std::size_t end) {
      return surface_node_at(side, surface_nodes, first, end) == surface_node_at(side, surface_nodes, last, end);
    };
    if (!border && one_node(0) && one_node(1)) continue;
    Ridge ridge{first.ends, {normal_of(first), normal_of(last)}, Point::Zero(), border};
    const Point& a = side.points[static_cast<std::size_t>(first.ends[0])];
    const Point before = side.geometry(first.facet).centre(), behind = side.geometry(last.facet).centre();
    if (!border && ridge.normals[0].dot((behind - a).normalized()) > -least_bend) continue;
    const Point mean = (ridge.normals[0] + ridge.normals[1]).normalized();
    ridge.across = across(border ? a - before : behind - before, along(side, first), mean);
    for (const std::size_t facet : {first.facet, last.facet})
      of_facets.emplace_back(static_cast<Local>(facet), static_cast<Local>(result.all.size()));
    result.all.push_back(ridge);
  }
  std::ranges::sort(of_facets);
  of_facets.erase(std::ranges::unique(of_facets).begin(), of_facets.end());
  result.offset.assign(side.facets.size() + 1, 0);
  for (const auto& [facet, ridge] : of_facets) {
    ++result.offset[static_cast<std::size_t>(facet) + 1];
    result.of.push_back(ridge);
  }
  for (std::size_t f = 0; f < side.facets.size(); ++f) result.offset[f + 1] += result.offset[f];
  return result;
}

}  // namespace mortise::contact
