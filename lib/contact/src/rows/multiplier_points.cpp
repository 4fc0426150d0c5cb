#include "rows/multiplier_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/facets_round.hpp"

namespace mortise::contact {

std::pair<Point, Point> MultiplierPoints::at(std::size_t p)
{
  const Point& node = secondary_.points[static_cast<std::size_t>(nodes_.all[faces_.surface_node(p)].node)];
  const Point& normal = rays_.own_normal(faces_.surface_node(p));
  if (const auto place = nearest_place(p)) return point_at(*place);
  Point shift = Point::Zero(), tilt = Point::Zero();
  double d = 0;
  for (const auto& [face, i, k] : faces_.at(p)) {
    const auto piece = faces_.piece(i);
    d += piece.covered[k];
    if (piece.point_facet.empty() || piece.covered[k] == 0) continue;
    const auto facet = static_cast<std::size_t>(piece.point_facet[static_cast<std::size_t>(k)]);
    for (std::size_t c = 0; c < secondary_.facets[facet].size(); ++c) {
      const double part = piece.covered[k] * piece.points(k, static_cast<Eigen::Index>(c));
      shift += part * (secondary_.points[static_cast<std::size_t>(secondary_.facets[facet][c])] - node);
      tilt += part * (rays_.own_normal(facet, c) - normal);
    }
  }
  return {node + shift / d, (normal + tilt / d).normalized()};
}

bool MultiplierPoints::means_field(std::size_t p)
{
  return faces_.is_corner(p) || !rays_.at_middle(p) || std::ranges::all_of(faces_.at(p), [&](const CutFaces::Function& function) {
           return !faces_.piece(function.piece).point_facet.empty();
         });
}

double MultiplierPoints::room(std::size_t p)
{
  constexpr double nothing = 1e-3;  // of the size of facets: so much sides that end together may lie beside each other
  if (faces_.is_corner(p)) return 0;
  const Local own = nodes_.all[faces_.surface_node(p)].node;
  const Point& node = secondary_.points[static_cast<std::size_t>(own)];
  const Point shift = nearest_place(p) ? Point(Point::Zero()) : Point(at(p).first - node);
  const double length = shift.norm();
  double farthest = 0, size = 0;
  for (const auto& function : faces_.at(p))
    for (auto facet = static_cast<std::size_t>(secondary_.first_facet[function.face]);
         facet < static_cast<std::size_t>(secondary_.first_facet[function.face + 1]); ++facet) {
      const auto corners = secondary_.facets[facet];
      if (std::find(corners.begin(), corners.end(), own) == corners.end()) continue;
      for (const Local n : corners) {
        const Point way = secondary_.points[static_cast<std::size_t>(n)] - node;
        farthest = std::max(farthest, way.dot(shift));
        size = std::max(size, way.norm());
      }
    }
  if (length <= nothing * size) return 1;
  return length * length < farthest ? 1 - length * length / farthest : 0;
}

std::pair<Point, Point> MultiplierPoints::point_at(const Rays::FacetPoint& place) const
{
  const auto corners = secondary_.facets[place.facet];
  Point at = Point::Zero(), normal = Point::Zero();
  for (std::size_t c = 0; c < corners.size(); ++c) {
    at += place.shape[static_cast<Eigen::Index>(c)] * secondary_.points[static_cast<std::size_t>(corners[c])];
    normal += place.shape[static_cast<Eigen::Index>(c)] * rays_.own_normal(place.facet, c);
  }
  return {at, normal.normalized()};
}

double MultiplierPoints::gap(std::size_t p, const Point& direction, double mean, const Rays::GapOf& gap_of)
{
  if (const auto place = nearest_place(p))
    if (const double gap = rays_.gap(p, *place, direction, gap_of); std::isfinite(gap)) return gap;
  const std::size_t node = faces_.surface_node(p);
  std::optional<double> first;  // the mean is taken of what others differ from it: of equals it is exact
  double sum = 0, d = 0, at_node = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [face, i, k] : faces_.at(p)) {
    const auto piece = faces_.piece(i);
    const double part = piece.covered[k];
    if (part == 0) continue;
    double gap = at_node;
    if (!piece.point_facet.empty()) {
      const auto facet = static_cast<std::size_t>(piece.point_facet[static_cast<std::size_t>(k)]);
      gap = rays_.gap(node, {facet, piece.points.row(k).transpose()}, direction, gap_of);
    } else if (std::isnan(gap)) {
      gap = at_node = rays_.gap(node, direction, gap_of);
    }
    if (!first) first = gap;
    d += part;
    sum += part * (gap - *first);
  }
  if (!first || !std::isfinite(*first) || !std::isfinite(sum)) return mean;
  return *first + sum / d;
}

// Where nearest_points() put a surface node, in the facet that it lies in: in the others round the node their smooth surface is
// continued beyond their border.
std::optional<Rays::FacetPoint> MultiplierPoints::nearest_place(std::size_t p)
{
  constexpr double rounding = 1e-9;
  if (!moved(p)) return {};
  for (const auto& [face, i, k] : faces_.at(p)) {
    const auto piece = faces_.piece(i);
    if (piece.facet < 0 || piece.point_facet.empty() || piece.point_facet[static_cast<std::size_t>(k)] < 0) continue;
    const auto facet = static_cast<std::size_t>(piece.facet);
    const Eigen::Vector4d shape = shape_beside(secondary_, facet, static_cast<std::size_t>(k), nearest_[p].shift);
    const auto corners = static_cast<Eigen::Index>(secondary_.facets[facet].size());
    if (shape.head(corners).minCoeff() >= -rounding && (piece.points.row(k).transpose() - shape).norm() < rounding)
      return Rays::FacetPoint{facet, shape};
  }
  return {};
}

}  // namespace mortise::contact
