#include "surface/facets_round.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace mortise::contact {

namespace {

// Of shape functions: what a place in a facet may lie outside of it by rounding, and by what planes of two facets differ by.
constexpr double within = 1e-6, between_planes = 0.02;

}  // namespace

FacetsRound::FacetsRound(const Side& side, const SurfaceNodes& surface_nodes, const std::vector<std::size_t>& faces)
    : side_(side), nodes_(surface_nodes), first_(surface_nodes.all.size() + 1, 0)
{
  const auto each = [&](const auto& use) {
    for (const std::size_t f : faces)
      for (auto facet = static_cast<std::size_t>(side.first_facet[f]); facet < static_cast<std::size_t>(side.first_facet[f + 1]);
           ++facet)
        for (std::size_t k = 0; k < side.facets[facet].size(); ++k) use(facet, k, surface_node(facet, k));
  };
  each([&](std::size_t, std::size_t, std::size_t p) { ++first_[p + 1]; });
  for (std::size_t p = 0; p + 1 < first_.size(); ++p) first_[p + 1] += first_[p];
  corners_.resize(first_.back());
  auto next = first_;
  each([&](std::size_t facet, std::size_t k, std::size_t p) { corners_[next[p]++] = {facet, k}; });
}

Point FacetsRound::shift_to(const Corner& from, const Eigen::Vector4d& shape) const
{
  const auto nodes = side_.geometry(from.facet).nodes;
  const std::size_t count = nodes.size(), after = (from.corner + 1) % count, before = (from.corner + count - 1) % count;
  const auto part = [&](std::size_t k) { return shape[static_cast<Eigen::Index>(k)]; };
  const double opposite = count == 4 ? part((from.corner + 2) % 4) : 0;
  const Point along_first = (part(after) + opposite) * (nodes[after] - nodes[from.corner]);
  return count == 2 ? along_first : Point(along_first + (part(before) + opposite) * (nodes[before] - nodes[from.corner]));
}

std::optional<FacetsRound::PointInFacet> FacetsRound::holds(std::size_t p, const Point& shift) const
{
  std::optional<PointInFacet> best;
  double least = -between_planes;
  for (const auto& [facet, corner] : round(p)) {
    const auto shape = shape_beside(side_, facet, corner, shift);
    const double smallest = shape.head(static_cast<Eigen::Index>(side_.facets[facet].size())).minCoeff();
    if (smallest < -within && !beside_shared_edge(p, {facet, corner, shape})) continue;
    if (smallest >= least && (!best || smallest > least)) best = {facet, corner, shape}, least = smallest;
  }
  return best;
}

bool FacetsRound::beside_shared_edge(std::size_t p, const PointInFacet& place) const
{
  const auto nodes = side_.facets[place.facet];
  const std::size_t count = nodes.size(), after = (place.corner + 1) % count, before = (place.corner + count - 1) % count;
  if (count == 2) return false;
  const auto shape = [&](std::size_t k) { return place.shape[static_cast<Eigen::Index>(k)]; };
  const double opposite = count == 4 ? shape((place.corner + 2) % 4) : 0;
  const double along_first = shape(after) + opposite, along_last = shape(before) + opposite;
  const bool far = count == 4 ? std::max(along_first, along_last) > 1 + within : shape(place.corner) < -within;
  return !far && (along_first >= -within || shared(p, place.facet, nodes[before])) &&
         (along_last >= -within || shared(p, place.facet, nodes[after]));
}

bool FacetsRound::shared(std::size_t p, std::size_t facet, Local node) const
{
  return std::ranges::any_of(round(p), [&](const Corner& other) {
    return other.facet != facet && std::ranges::find(side_.facets[other.facet], node) != side_.facets[other.facet].end();
  });
}

bool FacetsRound::is_nearest(const PointInFacet& place) const
{
  constexpr double same = 1e-3;
  const auto number = [&](std::size_t k) { return side_.node_id[static_cast<std::size_t>(side_.facets[place.facet][k])]; };
  const double own = place.shape[static_cast<Eigen::Index>(place.corner)];
  for (std::size_t k = 0; k < side_.facets[place.facet].size(); ++k) {
    if (k == place.corner) continue;
    const double other = place.shape[static_cast<Eigen::Index>(k)];
    if (other > own + same || (other > own - same && number(k) < number(place.corner))) return false;
  }
  return true;
}

double FacetsRound::part_within(const PointInFacet& place) const
{
  const double own = place.shape[static_cast<Eigen::Index>(place.corner)];
  double part = 1;
  for (std::size_t k = 0; k < side_.facets[place.facet].size(); ++k) {
    const double other = place.shape[static_cast<Eigen::Index>(k)];
    if (k != place.corner && other > own) part = std::min(part, 1 / (1 + other - own));
  }
  return part;
}

Eigen::Vector4d shape_beside(const Side& side, std::size_t facet, std::size_t corner, const Point& shift)
{
  const auto face = side.geometry(facet);
  const std::size_t count = face.nodes.size(), after = (corner + 1) % count, before = (corner + count - 1) % count;
  const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(k); };
  Eigen::Vector4d shape = Eigen::Vector4d::Zero();
  const Point first = face.nodes[after] - face.nodes[corner];
  if (count == 2) {
    const double s = shift.dot(first) / first.squaredNorm();
    shape[at(corner)] = 1 - s;
    shape[at(after)] = s;
    return shape;
  }
  Eigen::Matrix<double, 3, 2> edges;
  edges << first, face.nodes[before] - face.nodes[corner];
  const Eigen::Vector2d s = (edges.transpose() * edges).inverse() * (edges.transpose() * shift);
  if (count == 3) {
    shape[at(corner)] = 1 - s[0] - s[1];
    shape[at(after)] = s[0];
    shape[at(before)] = s[1];
  } else {
    shape[at(corner)] = (1 - s[0]) * (1 - s[1]);
    shape[at(after)] = s[0] * (1 - s[1]);
    shape[at(before)] = (1 - s[0]) * s[1];
    shape[at((corner + 2) % count)] = s[0] * s[1];
  }
  return shape;
}

}  // namespace mortise::contact
