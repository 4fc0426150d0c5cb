#include "search/over_facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/facets_round.hpp"

namespace mortise::contact {

namespace {

// Of shape functions: what lies outside of a facet by rounding.
constexpr double outside_facet = 1e-6;
// Of a distance: what is longer is as long but for rounding.
constexpr double nearer = 1 - 1e-6;
// Of a facet: how far beyond a border others are looked for.
constexpr double beyond = 1e-3;

}  // namespace

OverFacets::OverFacets(const Side& secondary, const Side& primary, const SurfaceNodes& primary_nodes, const Tree& tree,
                       const LineOfSight& sight, const Rays& rays, double reach)
    : secondary_(secondary),
      primary_(primary),
      primary_nodes_(primary_nodes),
      tree_(tree),
      sight_(sight),
      rays_(rays),
      reach_(reach),
      ridges_(find_ridges(primary, primary_nodes)),
      nodes_over_(secondary.facets.size()),
      ridges_over_(secondary.facets.size())
{
}

const std::vector<int>& OverFacets::met_by(std::size_t facet)
{
  const auto own = secondary_.geometry(facet);
  Box box;
  for (const auto& x : own.nodes) box.extend(x);
  tree_.swept(box, reach_ * frame_of(own).normal, met_);
  return met_;
}

const std::vector<OverFacets::NodeOver>& OverFacets::nodes_over(std::size_t facet)
{
  auto& known = nodes_over_[facet];
  if (known) return *known;
  auto& found = known.emplace();
  const auto own = secondary_.geometry(facet);
  const auto corners = own.nodes.size();
  const Point normal = frame_of(own).normal;
  const Bulge bulge = rays_.own_bulge(facet);
  for (const int met : met_by(facet)) {
    const auto other = static_cast<std::size_t>(met);
    const auto nodes = primary_.facets[other];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (primary_nodes_.normal(primary_, other, k).dot(normal) > opposed) continue;
      if (std::ranges::find(found, nodes[k], &NodeOver::node) != found.end()) continue;
      const Point& x = primary_.points[static_cast<std::size_t>(nodes[k])];
      const Eigen::Vector4d shape = shape_beside(secondary_, facet, 0, x - own.nodes[0]);
      if (!(shape.head(static_cast<Eigen::Index>(corners)).minCoeff() >= -outside_facet)) continue;
      Point at = Point::Zero();
      for (std::size_t c = 0; c < corners; ++c) at += shape[static_cast<Eigen::Index>(c)] * own.nodes[c];
      const double distance = (x - at).dot(normal), gap = distance - bulge.along(normal, shape);
      if (!(std::abs(gap) > reach_)) found.push_back({nodes[k], shape, at, distance, gap, primary_.geometry(other).size()});
    }
  }
  std::ranges::sort(found, {}, &NodeOver::node);  // in an order that does not depend on how the model is turned
  return found;
}

double OverFacets::least_gap(std::size_t facet, const Counts& counts)
{
  double least = std::numeric_limits<double>::infinity();
  for (const auto& node : nodes_over(facet))
    if (node.gap < least && counts(node.shape) && !is_hidden(facet, node)) least = node.gap;
  return least;
}

std::optional<OverFacets::NearNode> OverFacets::nearest_node(std::size_t facet, const Point& from, double most,
                                                             const Counts& counts)
{
  std::optional<NearNode> best;
  for (const auto& node : nodes_over(facet)) {
    const double distance = (node.at - from).norm();
    if (node.gap > most || (best && distance >= nearer * best->distance) || !counts(node.shape) || is_hidden(facet, node))
      continue;
    best = NearNode{node.shape, distance, node.size};
  }
  return best;
}

bool OverFacets::is_hidden(std::size_t facet, const NodeOver& node) const
{
  const auto own = secondary_.geometry(facet);
  return sight_.hidden(node.at, frame_of(own).normal, node.distance, own.size());
}

const std::vector<OverFacets::RidgeOver>& OverFacets::ridges_over(std::size_t facet)
{
  auto& known = ridges_over_[facet];
  if (known) return *known;
  auto& found = known.emplace();
  if (ridges_.all.empty()) return found;
  const Point normal = frame_of(secondary_.geometry(facet)).normal;
  for (const int met : met_by(facet))
    for (const Local r : ridges_.of_facet(static_cast<std::size_t>(met))) {
      const Ridge& ridge = ridges_.all[static_cast<std::size_t>(r)];
      if (ridge.normals[0].dot(normal) > opposed || ridge.normals[1].dot(normal) > opposed) continue;
      if (std::ranges::find(found, r, &RidgeOver::ridge) == found.end()) found.push_back({r, met});
    }
  return found;
}

bool OverFacets::is_covered(std::size_t facet, const Point& at)
{
  const auto own = secondary_.geometry(facet);
  const Point along = frame_of(own).normal;
  return std::ranges::any_of(met_by(facet), [&](int met) {
    const Hit hit = shoot(at, along, primary_.geometry(static_cast<std::size_t>(met)));
    return hit.found && std::abs(hit.distance) <= reach_;
  });
}

std::optional<OverFacets::OnRidge> OverFacets::nearest_on_ridge(std::size_t facet, const Point& from)
{
  std::optional<OnRidge> best;
  const auto& ridges = ridges_over(facet);
  if (ridges.empty()) return best;
  const auto own = secondary_.geometry(facet);
  const Point along = frame_of(own).normal;
  for (const auto& [r, other] : ridges) {
    const Ridge& ridge = ridges_.all[static_cast<std::size_t>(r)];
    const Point& a = primary_.points[static_cast<std::size_t>(ridge.ends[0])];
    const Point edge = primary_.points[static_cast<std::size_t>(ridge.ends[1])] - a;
    const double rise = edge.dot(along), length = edge.norm();
    double part = 0;  // of the way from a; down a ridge that descends, or next to `from`
    if (std::abs(rise) > parallel_slopes * length)
      part = rise < 0 ? 1 : 0;
    else if (length > 0)
      part = std::clamp((from - a).dot(edge) / (length * length), 0.0, 1.0);
    const Point x = a + part * edge;
    const Hit below = shoot(x, -along, own, outside_facet);
    if (!below.found) continue;
    const Point at = x - below.distance * along;
    // Nearer than on the faces on both sides.
    const Point normal = rays_.own_normal(Rays::FacetPoint{facet, below.shape});
    const double before = (normal + ridge.normals[0]).dot(ridge.across), behind = (normal + ridge.normals[1]).dot(ridge.across);
    const auto facet_there = static_cast<std::size_t>(other);
    const double turn = curvature_of(primary_, primary_nodes_, facet_there) * primary_.geometry(facet_there).size();
    if (ridge.border ? !(before < -parallel_over(turn)) : !(before < -parallel_slopes && behind > parallel_slopes)) continue;
    const double gap = below.distance - rays_.own_bulge(facet).along(along, below.shape), distance = (at - from).norm();
    if (std::abs(gap) > reach_ || (best && distance >= best->distance)) continue;
    if (sight_.hidden(at, along, below.distance, own.size())) continue;
    if (ridge.border && !is_covered(facet, at + beyond * own.size() * ridge.across)) continue;
    best = OnRidge{below.shape, distance};
  }
  return best;
}

}  // namespace mortise::contact
