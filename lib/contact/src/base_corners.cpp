#include "base_corners.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mortise::contact {

namespace {

constexpr double sharp_angle = 150 * 3.14159265358979 / 180;
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
    const auto corner = std::find_if(sharp.begin(), sharp.end(), [&](const BaseCorner& c) { return here(c.at); });
    if (corner != sharp.end()) result.push_back(*corner);
  }
  const auto by_node = [](const BaseCorner& a, const BaseCorner& b) { return a.primary_node < b.primary_node; };
  std::sort(result.begin(), result.end(), by_node);
  const auto same = [](const BaseCorner& a, const BaseCorner& b) { return a.primary_node == b.primary_node; };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  return result;
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
