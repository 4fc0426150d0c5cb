#include "opposite.hpp"

#include <cmath>

#include "face_integrals.hpp"

namespace mortise::contact {

namespace {

// Curvature below this part of 1 / size of a facet is rounding.
constexpr double least_curvature = 1e-8;
// How far a line may pass the border of a face that it meets continued, in shape functions.
constexpr double beyond_border = 1;

// How far lines may miss the other side: this part of the size of the facets that they start from. Corners of faces that are
// nearly covered lie so far beyond its border, and where the surfaces are curved projections along normals of facets and lines
// along the direction of contact differ a little.
constexpr double part_past = 0.4;
// Of that what a node may miss that lies on the border but for the tilt of its normal.
constexpr double on_border = 0.1;

// The largest change of the normals along the edges of a facet, per length.
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
           const Tree& tree, const std::optional<Obstacle>& obstacle, double reach)
    : secondary_(secondary),
      nodes_(surface_nodes),
      primary_(primary),
      primary_nodes_(primary_nodes),
      tree_(tree),
      reach_(reach),
      obstacle_(obstacle.has_value()),
      face_of_middle_(surface_nodes.all.size(), {-1, -1}),
      met_index_(surface_nodes.all.size(), -1)
{
  for (std::size_t f = 0; f < secondary.faces.size(); ++f)
    for (auto k = static_cast<std::size_t>(mesh::corner_count(secondary.faces.type[f])); k < secondary.faces[f].size(); ++k)
      face_of_middle_[static_cast<std::size_t>(surface_nodes.of_node[static_cast<std::size_t>(secondary.faces.offset[f]) + k])] =
          {static_cast<Local>(f), static_cast<Local>(k)};
  if (!obstacle) {
    curvature_ = mean_round(secondary, surface_nodes, [&](std::size_t f) { return curvature_of(secondary, surface_nodes, f); });
    past_ = mean_round(secondary, surface_nodes, [&](std::size_t f) { return part_past * secondary.geometry(f).size(); });
    return;
  }
  // The directions of contact are the obstacle's normals; where a surface node does not face it, it is out of reach.
  for (auto& surface_node : surface_nodes.all) {
    ClosestPoint at = closest_point(*obstacle, secondary.points[static_cast<std::size_t>(surface_node.node)]);
    if (surface_node.normal.dot(at.normal) > opposed) at.distance = std::numeric_limits<double>::infinity();
    if (std::isfinite(at.distance)) surface_node.normal = -at.normal;
    distance_.push_back(at.distance);
  }
}

Opposite Rays::shoot(const Point& from, const Point& direction, double length) const
{
  Opposite best;
  const Point room = Point::Constant(0.02 * length);  // a hit may lie a little beside its face
  for (const int m : tree_.swept(Box(from - room, from + room), length * direction)) {
    const auto facet = static_cast<std::size_t>(m);
    const auto hit = contact::shoot(from, direction, primary_.geometry(facet));
    if (!hit.found) continue;
    const double gap = hit.distance - Bulge(primary_, primary_nodes_, facet)(hit.shape);
    if (std::abs(gap) <= length && std::abs(gap) < std::abs(best.gap)) best = {gap, facet, hit};
  }
  return best;
}

Opposite Rays::shoot_past(const Point& from, const Point& direction, double length, double past) const
{
  Opposite best = shoot(from, direction, length);
  if (std::isfinite(best.gap)) return best;
  const Point room = Point::Constant(past);
  double least = past;
  for (const int m : tree_.swept(Box(from - room, from + room), length * direction)) {
    const auto facet = static_cast<std::size_t>(m);
    const auto geometry = primary_.geometry(facet);
    const auto hit = contact::shoot(from, direction, geometry, beyond_border);
    if (!hit.found) continue;
    const double by = -hit.shape.head(static_cast<Eigen::Index>(geometry.nodes.size())).minCoeff() * geometry.size();
    const double gap = hit.distance - Bulge(primary_, primary_nodes_, facet)(hit.shape);
    if (std::abs(gap) > length || by > least) continue;
    least = by;
    best = {gap, facet, hit};
  }
  return best;
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
      opposite = shoot_past(secondary_.points[static_cast<std::size_t>(surface_node.node)], surface_node.normal, reach_,
                            on_border * past_[p]);
    met_.push_back(opposite);
  }
  return met_[static_cast<std::size_t>(met_index_[p])];
}

Point Rays::direction(std::size_t p, const Point& at, const Point& normal) const
{
  if (obstacle_) return normal;
  const auto opposite = shoot_past(at, normal, 2 * reach_, past_[p]);
  if (!std::isfinite(opposite.gap)) return normal;
  Point other = Point::Zero();
  double length = 0;
  const auto geometry = primary_.geometry(opposite.facet);
  for (std::size_t k = 0; k < geometry.nodes.size(); ++k)
    other += opposite.hit.shape[static_cast<Eigen::Index>(k)] * primary_nodes_.normal(primary_, opposite.facet, k);
  length = geometry.size();
  other.normalize();
  const double own = curvature_[p] + least_curvature / length;
  const double others = curvature_of(primary_, primary_nodes_, opposite.facet) + least_curvature / length;
  return (others * normal - own * other).normalized();
}

double Rays::gap(std::size_t p, const Point& direction, const GapOf& gap_of) const
{
  const auto from = [&](std::size_t surface_node) {
    Opposite opposite;
    if (obstacle_)
      opposite.gap = distance_[surface_node];
    else
      opposite = shoot_past(secondary_.points[static_cast<std::size_t>(nodes_.all[surface_node].node)], direction, 2 * reach_,
                            past_[surface_node]);
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
  auto opposite = shoot_past(at, direction, 2 * reach_, part_past * geometry.size());
  opposite.gap -= Bulge(secondary_, nodes_, point.facet)(point.shape);
  return gap_of && std::isfinite(opposite.gap) ? gap_of(p, opposite) : opposite.gap;
}

}  // namespace mortise::contact
