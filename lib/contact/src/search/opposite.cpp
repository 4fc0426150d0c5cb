#include "search/opposite.hpp"

#include <algorithm>
#include <cmath>

#include "integrals/face_integrals.hpp"

namespace mortise::contact {

namespace {

// Curvature below this part of 1 / size of a facet is rounding.
constexpr double rounding_of_curvature = 1e-8;
// How far a line may pass the border of a face that it meets continued, in shape functions.
constexpr double beyond_border = 1;

// How far lines may miss the other side: this part of the size of the facets that they start from. Corners of faces that are
// nearly covered lie so far beyond its border, and where the surfaces are curved projections along normals of facets and lines
// along the direction of contact differ a little.
constexpr double part_past = 0.4;
// Of that what a node may miss that lies on the border but for the tilt of its normal.
constexpr double on_border = 0.1;
// Of an edge's length: what control values may say of an overlap where there is none.
constexpr double least_excess = 1e-4;
// Cosines nearer than this are equal.
constexpr double no_better = 0.01;
// Of the length of a line: what is as near is no nearer.
constexpr double same_gap = 1e-7;
// The curvature of a convex edge, over that of a ball of the size of the faces there.
constexpr double curvature_of_edge = 1e3;

// Of a plane 0.
double curvature_of(const Obstacle& obstacle)
{
  return obstacle.shape == Obstacle::Shape::plane ? 0 : 1 / obstacle.radius;
}

// The mean over the facets round each surface node.
template <class Value>
std::vector<double> mean_round(const Side& side, const SurfaceNodes& surface_nodes, const Value& value)
{
  std::vector<double> sum(surface_nodes.all.size(), 0.0), count(surface_nodes.all.size(), 0.0);
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const double of_facet = value(f);
    for (std::size_t k = 0; k < side.facets[f].size(); ++k) {
      const auto surface_node =
          static_cast<std::size_t>(surface_nodes.of_corner[static_cast<std::size_t>(side.facets.offset[f]) + k]);
      sum[surface_node] += of_facet;
      ++count[surface_node];
    }
  }
  for (std::size_t p = 0; p < sum.size(); ++p) sum[p] /= std::max(count[p], 1.0);
  return sum;
}

}  // namespace

Rays::Rays(const Side& secondary, SurfaceNodes& surface_nodes, const Side& primary, const SurfaceNodes& primary_nodes,
           const Tree& tree, const LineOfSight& sight, const std::optional<Obstacle>& obstacle, double reach)
    : secondary_(secondary),
      nodes_(surface_nodes),
      primary_(primary),
      primary_nodes_(primary_nodes),
      tree_(tree),
      sight_(sight),
      reach_(reach),
      obstacle_(obstacle),
      face_of_middle_(surface_nodes.all.size(), {-1, -1}),
      met_index_(surface_nodes.all.size(), -1)
{
  for (const auto& surface_node : surface_nodes.all) own_normal_.push_back(surface_node.normal);
  for (std::size_t f = 0; f < secondary.faces.size(); ++f)
    for (auto k = static_cast<std::size_t>(mesh::corner_count(secondary.faces.type[f])); k < secondary.faces[f].size(); ++k)
      face_of_middle_[static_cast<std::size_t>(surface_nodes.of_node[static_cast<std::size_t>(secondary.faces.offset[f]) + k])] =
          {static_cast<Local>(f), static_cast<Local>(k)};
  curvature_ = mean_round(secondary, surface_nodes, [&](std::size_t f) { return curvature_of(secondary, surface_nodes, f); });
  edges_ = edges_at(secondary, surface_nodes);
  past_ = mean_round(secondary, surface_nodes, [&](std::size_t f) { return part_past * secondary.geometry(f).size(); });
  if (!obstacle) {
    primary_edges_ = edges_at(primary, primary_nodes);
    return;
  }
  // Where a surface node does not face the obstacle, it is out of reach.
  for (std::size_t p = 0; p < surface_nodes.all.size(); ++p) {
    auto& surface_node = surface_nodes.all[p];
    const Point& x = secondary.points[static_cast<std::size_t>(surface_node.node)];
    const SignedDistance closest = signed_distance(*obstacle, x);
    distance_.push_back(std::numeric_limits<double>::infinity());
    if (!std::isfinite(closest.distance) || surface_node.normal.dot(closest.normal) > opposed) continue;
    surface_node.normal = direction_to_obstacle(p, closest, surface_node.normal);
    distance_.back() = distance_to_obstacle(x, surface_node.normal);
  }
}

Opposite Rays::shoot(const Point& from, const Point& direction, double length, const Counts& counts) const
{
  std::array<Opposite, 2> best;                       // before and behind
  std::array<double, 2> against{0, 0};                // cosines between the line and their normals
  const Point room = Point::Constant(0.02 * length);  // a hit may lie a little beside its face
  tree_.swept(Box(from - room, from + room), length * direction, swept_);
  for (const int m : swept_) {
    const auto facet = static_cast<std::size_t>(m);
    const auto geometry = primary_.geometry(facet);
    const auto hit = contact::shoot(from, direction, geometry);
    if (!hit.found || (counts && !counts(facet))) continue;
    const double gap = hit.distance - Bulge(primary_, primary_nodes_, facet).along(direction, hit.shape);
    if (std::abs(gap) > length) continue;
    const std::size_t way = gap < 0 ? 1 : 0;
    // In a concave edge of the primary side two faces are equally near.
    const double cosine = geometry.normal().dot(direction), nearer = std::abs(best[way].gap) - std::abs(gap);
    if (nearer < -same_gap * length || (nearer < same_gap * length && cosine >= against[way])) continue;
    best[way] = {gap, facet, hit};
    against[way] = cosine;
  }
  const double nearer = std::abs(best[0].gap) - std::abs(best[1].gap);
  if (nearer > same_gap * length || (nearer > -same_gap * length && against[1] < against[0])) std::swap(best[0], best[1]);
  for (const auto& opposite : best)
    if (std::isfinite(opposite.gap) &&
        !sight_.hidden(from, direction, opposite.hit.distance, primary_.geometry(opposite.facet).size()))
      return opposite;
  return {};
}

Opposite Rays::shoot_past(const Point& from, const Point& direction, double length, double past, const Counts& counts) const
{
  Opposite best = shoot(from, direction, length, counts);
  if (std::isfinite(best.gap)) return best;
  const Point room = Point::Constant(past);
  double least = past;
  tree_.swept(Box(from - room, from + room), length * direction, swept_);
  for (const int m : swept_) {
    const auto facet = static_cast<std::size_t>(m);
    const auto geometry = primary_.geometry(facet);
    const auto hit = contact::shoot(from, direction, geometry, beyond_border);
    if (!hit.found || (counts && !counts(facet))) continue;
    const double by = -hit.shape.head(static_cast<Eigen::Index>(geometry.nodes.size())).minCoeff() * geometry.size();
    const double gap = hit.distance - Bulge(primary_, primary_nodes_, facet).along(direction, hit.shape);
    if (std::abs(gap) > length || by > least) continue;
    least = by;
    best = {gap, facet, hit};
  }
  if (std::isfinite(best.gap) && sight_.hidden(from, direction, best.hit.distance, primary_.geometry(best.facet).size()))
    return {};
  return best;
}

Opposite Rays::shoot_past(std::size_t p, const Point& from, const Point& direction, double length, double past) const
{
  if (const auto& beside = edges_.beside[p]; !beside.empty()) {
    const Point& own = nodes_.all[p].normal;
    const auto found = shoot_past(from, direction, length, past, [&](std::size_t facet) {
      const Point normal = primary_.geometry(facet).normal();
      return std::none_of(beside.begin(), beside.end(),
                          [&](const Point& other) { return normal.dot(other) < normal.dot(own) - no_better; });
    });
    if (std::isfinite(found.gap)) return found;
  }
  return shoot_past(from, direction, length, past);
}

const Opposite& Rays::meet(std::size_t p)
{
  if (met_index_[p] < 0) {
    met_index_[p] = static_cast<Local>(met_.size());
    const SurfaceNode& surface_node = nodes_.all[p];
    Opposite opposite;
    if (obstacle_)
      opposite.gap = distance_[p];
    else
      opposite = shoot_past(p, secondary_.points[static_cast<std::size_t>(surface_node.node)], surface_node.normal, reach_,
                            on_border * past_[p]);
    met_.push_back(opposite);
  }
  return met_[static_cast<std::size_t>(met_index_[p])];
}

bool Rays::nearest_within(std::size_t f)
{
  const auto type = secondary_.faces.type[f];
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  const auto gap_at = [&](std::size_t k) {
    return meet(static_cast<std::size_t>(nodes_.of_node[static_cast<std::size_t>(secondary_.faces.offset[f]) + k])).gap;
  };
  const auto at = [&](int k) -> const Point& {
    return secondary_.points[static_cast<std::size_t>(secondary_.faces[f][static_cast<std::size_t>(k)])];
  };
  for (std::size_t m = corners; m < secondary_.faces[f].size(); ++m) {
    const auto& ends = mesh::middles(type)[m - corners];
    if (ends.size() != 2) continue;
    const double first = gap_at(static_cast<std::size_t>(ends[0])), last = gap_at(static_cast<std::size_t>(ends[1]));
    const double control = 2 * gap_at(m) - (first + last) / 2;
    if (!std::isfinite(first + last + control) || control >= std::min(first, last)) continue;
    // The least gap of the edge exceeds the control value by:
    const double excess = (first - control) * (last - control) / (first - 2 * control + last);
    if (excess > least_excess * (at(ends[1]) - at(ends[0])).norm()) return true;
  }
  return false;
}

Point Rays::direction(std::size_t p, const Point& at, const Point& normal) const
{
  if (obstacle_) {
    const auto closest = signed_distance(*obstacle_, at);
    return std::isfinite(closest.distance) ? direction_to_obstacle(p, closest, normal) : normal;
  }
  const auto opposite = shoot_past(p, at, normal, 2 * reach_, past_[p]);
  if (!std::isfinite(opposite.gap)) return normal;
  const Point other = primary_normal(opposite);
  const double length = primary_.geometry(opposite.facet).size();
  const bool on_edge = edges_.is_edge(p, normal, other, parallel_over(curvature_[p] * length));
  const double own = curvature_[p] * length + (on_edge ? curvature_of_edge : 0);
  const double others =
      curvature_of(primary_, primary_nodes_, opposite.facet) * length + curvature_of_edge * part_on_edges(opposite, normal);
  // Both as flat as each other where rounding tells their curvature, but nothing that tilts the normal of a plane beside what is
  // curved: bodies between parallel planes that are free along them would be driven.
  const double alike = rounding_of_curvature * std::exp(-std::max(own, others) / rounding_of_curvature);
  return ((others + alike) * normal - (own + alike) * other).normalized();
}

// What the shape functions of corners on convex edges make up at the place that is met.
double Rays::part_on_edges(const Opposite& opposite, const Point& normal) const
{
  const auto begin = static_cast<std::size_t>(primary_.facets.offset[opposite.facet]);
  const Point other = primary_normal(opposite);
  const double turn = curvature_of(primary_, primary_nodes_, opposite.facet) * primary_.geometry(opposite.facet).size();
  double part = 0;
  for (std::size_t k = 0; k < primary_.facets[opposite.facet].size(); ++k)
    if (const auto q = static_cast<std::size_t>(primary_nodes_.of_corner[begin + k]);
        primary_edges_.is_edge(q, other, normal, parallel_over(turn)))
      part += opposite.hit.shape[static_cast<Eigen::Index>(k)];
  return std::clamp(part, 0.0, 1.0);
}

Point Rays::direction_to_obstacle(std::size_t p, const SignedDistance& closest, const Point& normal) const
{
  if (obstacle_->shape == Obstacle::Shape::plane) return -closest.normal;
  const double parallel = parallel_over(curvature_[p] * past_[p] / part_past);
  const double edge = edges_.is_edge(p, normal, closest.normal, parallel) ? curvature_of_edge : 0;
  const double own = curvature_[p] + edge / obstacle_->radius;
  return (curvature_of(*obstacle_) * normal - own * closest.normal).normalized();
}

double Rays::distance_to_obstacle(const Point& at, const Point& direction) const
{
  const double distance = distance_along(*obstacle_, at, direction);
  return std::isfinite(distance) ? distance : signed_distance(*obstacle_, at).distance;
}

Point Rays::own_normal(const FacetPoint& point) const
{
  Point normal = Point::Zero();
  for (std::size_t k = 0; k < secondary_.facets[point.facet].size(); ++k)
    normal += point.shape[static_cast<Eigen::Index>(k)] * own_normal(point.facet, k);
  return normal.normalized();
}

double Rays::rise_of(const Opposite& met) const
{
  return std::isfinite(met.gap) ? std::abs(Bulge(primary_, primary_nodes_, met.facet)(met.hit.shape)) : 0.0;
}

Point Rays::primary_normal(const Opposite& opposite) const
{
  Point normal = Point::Zero();
  for (std::size_t k = 0; k < primary_.facets[opposite.facet].size(); ++k)
    normal += opposite.hit.shape[static_cast<Eigen::Index>(k)] * primary_nodes_.normal(primary_, opposite.facet, k);
  return normal.normalized();
}

Rays::Tilt Rays::tilt_to(std::size_t p, const Point& own, const Opposite& opposite) const
{
  return {own + primary_normal(opposite), curvature_[p] + curvature_of(primary_, primary_nodes_, opposite.facet)};
}

Bulge Rays::own_bulge(std::size_t facet) const
{
  return {secondary_, nodes_, facet, own_normal_};
}

std::optional<Rays::Tilt> Rays::tilt(std::size_t p)
{
  if (obstacle_) {
    if (!std::isfinite(distance_[p])) return std::nullopt;
    const auto closest = signed_distance(*obstacle_, secondary_.points[static_cast<std::size_t>(nodes_.all[p].node)]);
    return Tilt{own_normal_[p] + closest.normal, curvature_[p] + curvature_of(*obstacle_)};
  }
  const Opposite& opposite = meet(p);
  if (!std::isfinite(opposite.gap)) return std::nullopt;
  return tilt_to(p, own_normal_[p], opposite);
}

std::optional<Rays::Tilt> Rays::tilt(std::size_t p, std::size_t facet, const Eigen::Vector4d& shape) const
{
  const auto geometry = secondary_.geometry(facet);
  const Point normal = own_normal(FacetPoint{facet, shape});
  Point at = Point::Zero();
  for (std::size_t k = 0; k < geometry.nodes.size(); ++k) at += shape[static_cast<Eigen::Index>(k)] * geometry.nodes[k];
  if (obstacle_) {
    const auto closest = signed_distance(*obstacle_, at);
    if (!std::isfinite(closest.distance)) return std::nullopt;
    return Tilt{normal + closest.normal, curvature_[p] + curvature_of(*obstacle_)};
  }
  const auto opposite = shoot(at, normal, reach_, {});
  if (!std::isfinite(opposite.gap)) return std::nullopt;
  return tilt_to(p, normal, opposite);
}

double Rays::gap(std::size_t p, const Point& direction, const GapOf& gap_of) const
{
  const auto from = [&](std::size_t surface_node) {
    const Point& at = secondary_.points[static_cast<std::size_t>(nodes_.all[surface_node].node)];
    Opposite opposite;
    if (obstacle_)
      opposite.gap = std::isfinite(distance_[surface_node]) ? distance_to_obstacle(at, direction) : distance_[surface_node];
    else
      opposite = shoot_past(surface_node, at, direction, 2 * reach_, past_[surface_node]);
    return gap_of && std::isfinite(opposite.gap) ? gap_of(surface_node, opposite) : opposite.gap;
  };
  const auto [face, node] = face_of_middle_[p];
  if (face < 0) return from(p);
  const auto f = static_cast<std::size_t>(face);
  const auto control = control_values(secondary_.faces.type[f]).row(node);
  double gap = 0;
  for (Eigen::Index k = 0; k < control.size(); ++k)
    if (control[k] != 0)
      gap +=
          control[k] * from(static_cast<std::size_t>(nodes_.of_node[static_cast<std::size_t>(secondary_.faces.offset[f] + k)]));
  return gap;
}

double Rays::gap(std::size_t p, const FacetPoint& point, const Point& direction, const GapOf& gap_of) const
{
  const auto geometry = secondary_.geometry(point.facet);
  Point at = Point::Zero();
  for (std::size_t k = 0; k < geometry.nodes.size(); ++k) at += point.shape[static_cast<Eigen::Index>(k)] * geometry.nodes[k];
  auto opposite = obstacle_ ? Opposite{distance_to_obstacle(at, direction), 0, {}}
                            : shoot_past(p, at, direction, 2 * reach_, part_past * geometry.size());
  opposite.gap -= own_bulge(point.facet).along(direction, point.shape);
  return gap_of && std::isfinite(opposite.gap) ? gap_of(p, opposite) : opposite.gap;
}

}  // namespace mortise::contact
