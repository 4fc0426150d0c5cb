#include "integrals/base_corners.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mortise::contact {

namespace {

constexpr double degree = 3.14159265358979 / 180, sharp_angle = 150 * degree, least_turn = 5 * degree;
// Of a face's length: places nearer to each other are one.
constexpr double same_place = 1e-7;

double length_of(std::span<const Plane> nodes)
{
  double length = 0;
  for (const auto& node : nodes) length = std::max(length, (node - nodes[0]).norm());
  return length;
}

}  // namespace

std::vector<char> sharp_nodes(const Side& side)
{
  std::vector<double> angle(side.points.size(), 0.0);
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto facet = side.facets[f];
    const auto at = [&](std::size_t k) -> const Point& { return side.points[static_cast<std::size_t>(facet[k % facet.size()])]; };
    for (std::size_t k = 0; k < facet.size() && facet.size() > 2; ++k) {
      const Point next = at(k + 1) - at(k), last = at(k + facet.size() - 1) - at(k);
      angle[static_cast<std::size_t>(facet[k])] += std::atan2(next.cross(last).norm(), next.dot(last));
    }
  }
  std::vector<char> result;
  for (const double a : angle) result.push_back(a > 0 && a < sharp_angle);
  return result;
}

std::vector<std::array<bool, 4>> border_edges(const Side& side)
{
  std::vector<std::array<bool, 4>> result(side.facets.size(), {false, false, false, false});
  struct Edge {
    std::pair<Local, Local> ends;
    std::size_t facet, number;
  };
  std::vector<Edge> edges;
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto facet = side.facets[f];
    for (std::size_t k = 0; k < facet.size() && facet.size() > 2; ++k)
      edges.push_back({std::minmax({facet[k], facet[(k + 1) % facet.size()]}), f, k});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end].ends == edges[first].ends) ++end;
    if (end == first + 1) result[edges[first].facet][edges[first].number] = true;
  }
  return result;
}

std::optional<Plane> crossing(const Plane& a, const Plane& b, const Plane& c, const Plane& d)
{
  constexpr double beyond_end = 1e-9;  // of an edge, where rounding may put a crossing
  const Plane u = b - a, v = c - d;    // both with the common part on their left
  const double turn = cross(u, v), along = u.dot(v);
  constexpr double parallel = 1e-9;
  // The borders turn by what is missing to a straight angle.
  if (std::abs(turn) < parallel * u.norm() * v.norm() || std::atan2(std::abs(turn), along) < least_turn) return {};
  const double s = cross(c - a, v) / turn, t = cross(c - a, u) / turn;  // a + s u = c - t v
  if (s < -beyond_end || s > 1 + beyond_end || t > beyond_end || t < -1 - beyond_end) return {};
  return Plane(a + s * u);
}

std::vector<BaseCorner> base_corners(std::span<const Plane> nodes, std::span<const CoveredPart> parts,
                                     std::span<const BaseCorner> sharp)
{
  std::vector<BaseCorner> result;
  if (sharp.empty()) return result;
  std::vector<Plane> all;
  for (const auto& part : parts) all.insert(all.end(), part.polygon.begin(), part.polygon.end());
  const double near = same_place * length_of(nodes);
  for (const std::size_t i : convex_hull(all)) {
    const auto here = [&](const Plane& x) { return (x - all[i]).norm() < near; };
    if (std::any_of(nodes.begin(), nodes.end(), here)) continue;
    const BaseCorner* best = nullptr;  // a node, if there is one
    for (const auto& corner : sharp)
      if (here(corner.at) && (!best || best->number < corner.number)) best = &corner;
    if (best) result.push_back(*best);
  }
  std::sort(result.begin(), result.end(), [](const BaseCorner& a, const BaseCorner& b) {
    return std::tuple(a.number < 0, a.number, a.at[0], a.at[1]) < std::tuple(b.number < 0, b.number, b.at[0], b.at[1]);
  });
  std::vector<BaseCorner> once;
  for (const auto& corner : result)
    if (std::none_of(once.begin(), once.end(), [&](const BaseCorner& c) { return (c.at - corner.at).norm() < 4 * near; }))
      once.push_back(corner);
  return once;
}

std::size_t node_beside(mesh::CellType type, std::span<const Plane> nodes, std::span<const Global> id, const Plane& at)
{
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  const double near = same_place * length_of(nodes);
  std::vector<std::size_t> candidates;
  for (std::size_t e = 0; e < corners && candidates.empty(); ++e) {
    const std::size_t end = (e + 1) % corners;
    if ((nearest_on(nodes[e], nodes[end], at) - at).norm() < near) candidates = {e, end};
  }
  for (std::size_t k = 0; k < corners && candidates.size() != 2; ++k) candidates.push_back(k);
  // Distances that are the same but for rounding are decided by the numbers.
  std::size_t best = candidates[0];
  for (const std::size_t k : candidates) {
    const double difference = (nodes[k] - at).norm() - (nodes[best] - at).norm();
    if (difference < -near || (difference < near && id[k] < id[best])) best = k;
  }
  return best;
}

}  // namespace mortise::contact
