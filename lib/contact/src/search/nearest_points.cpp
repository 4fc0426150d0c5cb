#include "search/nearest_points.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/dense.hpp"
#include "search/opposite.hpp"
#include "search/over_facets.hpp"
#include "surface/facets_round.hpp"

namespace mortise::contact {

namespace {

// By how much n + m has to change over the facets round a node: flat sides, where it is rounding, are nowhere nearest, and what
// less leaves between nodes is 1e-7 of a facet.
constexpr double flat = 1e-6;
// Of the size of the facets round a node: shorter steps are none, and those that start longer lead elsewhere.
constexpr double least_step = 1e-6, longest_step = 1.0;
// Of the sum of both sides' curvatures: what less of it is left between them is that of meshes.
constexpr double parallel = 0.3;
// Of the same size: how exactly the place is known. What is squeezed between two such places leaves sideways if they are not
// opposite each other: steps end where they are rounding, and a place that is not known to `known` is none.
constexpr double exact = 1e-15, known = 1e-10;
constexpr int most_steps = 60;
// By how much n + m has to change over one facet alone, whose nodes say less than those of all round a node.
constexpr double bent = 1e-3;
// Of what n + m changes by along an edge of the border: how far it may point inside there, where both bodies end in a plane of
// symmetry, or the other side comes nearer and nearer beyond.
constexpr double inside_border = 0.05;
// The same of what points across the border at all, both ways, where the place is looked for on it first: the faces on one side
// of it say nothing of what lies on the other.
constexpr double across_border = 1e-3;
class Search {
 public:
  Search(const Side& side, const SurfaceNodes& surface_nodes, const FacetsRound& facets, Rays& rays, OverFacets& over)
      : side_(side), nodes_(surface_nodes), facets_(facets), rays_(rays), over_(over)
  {
  }

  NearestPoint step(std::size_t p)
  {
    if (round(p).empty()) return {};
    size_ = 0;
    for (const auto& at : round(p)) size_ = std::max(size_, side_.geometry(at.facet).size());
    for (const auto& at : round(p))
      if (const auto found = step_along_border(p, at, true); found.found) return found;
    if (const auto found = step_to_ridge(p); found.found) return found;
    if (const auto found = step_from_node(p); found.found) return found;
    for (const auto& at : round(p))
      if (const auto found = step_into(p, at); found.found) return found;
    for (const auto& at : round(p))
      if (const auto found = step_along_border(p, at, false); found.found) return found;
    return looks_for_nodes(p) ? step_to_node(p) : NearestPoint();
  }

 private:
  using Corner = FacetsRound::Corner;

  // Newton's method from the node.
  NearestPoint step_from_node(std::size_t p)
  {
    const auto at_node = rays_.tilt(p);
    if (!at_node) return {};
    const auto inverse = inverse_change(p, round(p), *at_node, rays_.own_normal(p), flat, false);
    if (!inverse) return {};
    const Point shift = -(*inverse * at_node->difference);
    return shift.norm() < longest_step * size_ ? step_on(p, shift, *inverse) : NearestPoint();
  }

  // The same with what n + m changes by in one facet, where it grows all round: a bump may be little wider than that.
  NearestPoint step_into(std::size_t p, const Corner& at)
  {
    if (side_.facets.type[at.facet] == mesh::CellType::line2) return {};
    const auto at_node = rays_.tilt(p);
    if (!at_node) return {};
    const auto inverse = inverse_change(p, std::span(&at, 1), *at_node, rays_.own_normal(p), bent, true);
    if (!inverse) return {};
    const Point shift = -(*inverse * at_node->difference);
    const Eigen::Vector4d shape = shape_beside(side_, at.facet, at.corner, shift);
    const bool inside = shape.head(static_cast<Eigen::Index>(side_.facets[at.facet].size())).minCoeff() > 0;
    return inside ? step_on(p, shift, *inverse) : NearestPoint();
  }

  NearestPoint step_on(std::size_t p, const Point& shift, const Eigen::Matrix3d& inverse)
  {
    const auto found = newton(p, shift, inverse, shift, std::numeric_limits<double>::infinity());
    return found ? accepted(p, *found) : NearestPoint();
  }

  // The place that Newton's method goes to from a step, within `radius` of `centre`. In a flat, where n + m is the noise of the
  // coordinates, it goes nowhere: then the place at which it came there.
  std::optional<Point> newton(std::size_t p, Point shift, const Eigen::Matrix3d& inverse, const Point& centre, double radius)
  {
    std::optional<Point> in_flat;
    double last = size_;
    for (int i = 0; i < most_steps && last > exact * size_; ++i) {
      const auto place = facets_.holds(p, shift);
      const auto here = place ? rays_.tilt(p, place->facet, place->shape) : std::nullopt;
      if (!here) return in_flat;
      if (!in_flat && here->difference.norm() < flat) in_flat = shift;
      const Point change = -(inverse * here->difference);
      if ((shift + change - centre).norm() > radius) return in_flat;
      shift += change;
      last = change.norm();
    }
    return last < known * size_ ? shift : in_flat;
  }

  // Along the edges of a facet from a node that the border has, where n + m has nothing along them: by secants between both ends.
  // `symmetric`: where it has nothing across them either.
  NearestPoint step_along_border(std::size_t p, const Corner& at, bool symmetric)
  {
    const auto nodes = side_.facets[at.facet];
    const std::size_t count = nodes.size();
    if (count == 2) return {};
    for (const std::size_t end : {(at.corner + 1) % count, (at.corner + count - 1) % count}) {
      if (facets_.shared(p, at.facet, nodes[end])) continue;
      if (const auto found = step_along_edge(p, at, end, symmetric); found.found) return found;
    }
    return {};
  }

  NearestPoint step_along_edge(std::size_t p, const Corner& at, std::size_t end, bool symmetric)
  {
    const auto geometry = side_.geometry(at.facet);
    const Point edge = geometry.nodes[end] - geometry.nodes[at.corner];
    Point inside = -geometry.nodes[at.corner] - edge / 2;
    for (const auto& x : geometry.nodes) inside += x / static_cast<double>(geometry.nodes.size());
    inside -= inside.dot(edge) / edge.squaredNorm() * edge;
    const auto first = rays_.tilt(p), last = rays_.tilt(facets_.surface_node(at.facet, end));
    if (!first || !last) return {};
    double from = 0, to = 1, at_from = first->difference.dot(edge), at_to = last->difference.dot(edge);
    const double change = at_to - at_from, length = edge.norm();
    if (!(at_from <= 0) || !(at_to > 0) || !(change > bent * length) || !(change > parallel * first->curvature * length * length))
      return {};
    inside.normalize();
    const auto across = [&](const Rays::Tilt& tilt) {
      return std::abs(tilt.difference.dot(inside)) > across_border * change / length;
    };
    if (symmetric && (across(*first) || across(*last))) return {};
    double s = 0, step = 1;
    Rays::Tilt here = *first;
    for (int i = 0; i < most_steps && step > exact; ++i) {
      const double next = i % 3 == 2 ? (from + to) / 2 : from - at_from * (to - from) / (at_to - at_from);
      step = std::abs(next - s), s = next;
      Eigen::Vector4d shape = Eigen::Vector4d::Zero();
      shape[static_cast<Eigen::Index>(at.corner)] = 1 - s, shape[static_cast<Eigen::Index>(end)] = s;
      const auto found = rays_.tilt(p, at.facet, shape);
      if (!found) return {};
      here = *found;
      const double slope = here.difference.dot(edge);
      if (slope == 0) break;
      if (slope < 0)
        from = s, at_from = slope;
      else
        to = s, at_to = slope;
      if (to - from < exact) break;
    }
    if (here.difference.dot(inside) < -inside_border * change / length) return {};
    return accepted(p, s * edge);
  }

  // To an edge of the primary side.
  NearestPoint step_to_ridge(std::size_t p) const
  {
    std::optional<OverFacets::OnRidge> best;
    Corner where{};
    for (const auto& at : round(p)) {
      const auto found = over_.nearest_on_ridge(at.facet, side_.points[static_cast<std::size_t>(nodes_.all[p].node)]);
      if (!found || !facets_.is_nearest({at.facet, at.corner, found->shape})) continue;
      if (!best || found->distance < best->distance) best = found, where = at;
    }
    return best ? accepted(p, facets_.shift_to(where, best->shape)) : NearestPoint();
  }

  // Whether there are nodes of the primary side between those of the secondary one, or it ends there.
  bool looks_for_nodes(std::size_t p)
  {
    if (rays_.obstacle()) return false;
    for (const auto& [facet, corner] : round(p))
      for (std::size_t k = 0; k < side_.facets[facet].size(); ++k) {
        const auto& opposite = rays_.meet(facets_.surface_node(facet, k));
        if (!std::isfinite(opposite.gap) || rays_.size_of(opposite) < 0.5 * size_) return true;
      }
    return false;
  }

  // To the node of the primary side at which the gap is least, if it is less than here, and from there by differences. Where a
  // flat is touched all gaps are the same but for rounding: of those that differ by no more, to the nearest.
  NearestPoint step_to_node(std::size_t p)
  {
    const auto counts = [&](const Corner& at) {
      return [this, at](const Eigen::Vector4d& shape) { return facets_.is_nearest({at.facet, at.corner, shape}); };
    };
    double least = std::numeric_limits<double>::infinity();
    for (const auto& at : round(p)) least = std::min(least, over_.least_gap(at.facet, counts(at)));
    const double same = least_step * size_;
    if (!(least < rays_.meet(p).gap - same)) return {};
    std::optional<OverFacets::NearNode> best;
    Corner where{};
    for (const auto& at : round(p)) {
      const auto found =
          over_.nearest_node(at.facet, side_.points[static_cast<std::size_t>(nodes_.all[p].node)], least + same, counts(at));
      if (found && (!best || found->distance < best->distance - same)) best = found, where = at;
    }
    if (!best) return {};
    const Point shift = facets_.shift_to(where, best->shape);
    const auto here = rays_.tilt(p, where.facet, best->shape);
    if (!here) return {};
    const auto inverse = inverse_beside(p, shift, *here, std::min(0.1 * best->size, 0.01 * size_));
    if (!inverse) return {};
    const auto found = newton(p, shift, *inverse, shift, best->size);
    return found ? accepted(p, *found) : NearestPoint();
  }

  // A step that leads into a facet round the node, whose nearest node it is.
  NearestPoint accepted(std::size_t p, const Point& shift) const
  {
    const auto place = facets_.holds(p, shift);
    if (!place || !facets_.is_nearest(*place)) return {};
    return {true, shift.norm() < least_step * size_ ? Point(Point::Zero()) : Point(facets_.part_within(*place) * shift),
            place->facet, place->shape};
  }

  // The inverse of H in (n + m)(x) = (n + m)(x_p) + H (x - x_p) in the tangent plane, of least squares over the neighbours; zero
  // in directions in which the sides count as parallel or come nearer and nearer. None if there is no other.
  std::optional<Eigen::Matrix3d> inverse_change(std::size_t p, std::span<const Corner> corners, const Rays::Tilt& at_node,
                                                const Point& normal, double least, bool all_round)
  {
    const bool line = side_.facets.type[round(p)[0].facet] == mesh::CellType::line2;
    const Point first = line ? Point(-normal[1], normal[0], 0) : normal.unitOrthogonal();
    const Point second = line ? Point(Point::Zero()) : Point(normal.cross(first));
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  // unknowns H_11, H_12, H_22
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const Point& origin = side_.points[static_cast<std::size_t>(nodes_.all[p].node)];
    for (const auto& [facet, corner] : corners) {
      const auto count = side_.facets[facet].size();
      for (std::size_t k = 0; k < count; ++k) {
        if (k == corner) continue;
        const auto there = rays_.tilt(facets_.surface_node(facet, k));
        if (!there) continue;
        const Point step = side_.points[static_cast<std::size_t>(side_.facets[facet][k])] - origin;
        const Point change = there->difference - at_node.difference;
        const double x = step.dot(first), y = step.dot(second), weight = 1 / step.squaredNorm();
        const Eigen::Vector3d a(x, y, 0), b(0, x, y);
        squares += weight * (a * a.transpose() + b * b.transpose());
        right += weight * (change.dot(first) * a + change.dot(second) * b);
      }
    }
    Eigen::Matrix2d change = Eigen::Matrix2d::Zero();
    if (line) {
      if (!(squares(0, 0) > 0)) return std::nullopt;
      change(0, 0) = right[0] / squares(0, 0);
    } else {
      const auto inverse = dense::inverse(squares, 1e-6);
      if (!inverse) return std::nullopt;
      const Eigen::Vector3d h = *inverse * right;
      change << h[0], h[1], h[1], h[2];
    }
    return inverse_of(change, first, second, at_node.curvature, least, all_round);
  }

  // The same by differences at a step from the node.
  std::optional<Eigen::Matrix3d> inverse_beside(std::size_t p, const Point& shift, const Rays::Tilt& here, double length) const
  {
    const Point& normal = rays_.own_normal(p);
    const bool line = side_.facets.type[round(p)[0].facet] == mesh::CellType::line2;
    const Point first = line ? Point(-normal[1], normal[0], 0) : normal.unitOrthogonal();
    const Point second = line ? Point(Point::Zero()) : Point(normal.cross(first));
    Eigen::Matrix2d change = Eigen::Matrix2d::Zero();
    for (int i = 0; i < (line ? 1 : 2); ++i) {
      const Point& along = i == 0 ? first : second;
      // Both ways: where a plane runs into an arc the one alone would depend on the tangents.
      Point slope = Point::Zero();
      int ways = 0;
      for (const double step : {length, -length}) {
        const auto place = facets_.holds(p, shift + step * along);
        const auto there = place ? rays_.tilt(p, place->facet, place->shape) : std::nullopt;
        if (there) slope += (there->difference - here.difference) / step, ++ways;
      }
      if (ways == 0) return std::nullopt;
      slope /= ways;
      change.col(i) = Eigen::Vector2d(slope.dot(first), slope.dot(second));
    }
    return inverse_of(0.5 * (change + change.transpose()), first, second, here.curvature, flat, false);
  }

  std::optional<Eigen::Matrix3d> inverse_of(const Eigen::Matrix2d& change, const Point& first, const Point& second,
                                            double curvature, double least, bool all_round) const
  {
    const auto eigen = dense::plane_eigenpairs(change);
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    bool any = false;
    for (Eigen::Index i = 0; i < 2; ++i) {
      const double value = eigen.values[i];
      if (!(value > parallel * curvature) || !(value * size_ > least)) {
        if (all_round) return std::nullopt;
        continue;
      }
      const Point direction = eigen.vectors(0, i) * first + eigen.vectors(1, i) * second;
      inverse += direction * direction.transpose() / value;
      any = true;
    }
    if (!any) return std::nullopt;
    return inverse;
  }

  std::span<const Corner> round(std::size_t p) const { return facets_.round(p); }

  const Side& side_;
  const SurfaceNodes& nodes_;
  const FacetsRound& facets_;
  Rays& rays_;
  OverFacets& over_;
  double size_ = 0;  // of the facets round the node at work
};

}  // namespace

std::vector<NearestPoint> nearest_points(const Side& secondary, const SurfaceNodes& surface_nodes,
                                         const std::vector<std::size_t>& faces, Rays& rays, OverFacets& over)
{
  const FacetsRound facets(secondary, surface_nodes, faces);
  Search search(secondary, surface_nodes, facets, rays, over);
  std::vector<NearestPoint> result(surface_nodes.all.size());
  for (std::size_t p = 0; p < result.size(); ++p) result[p] = search.step(p);
  return result;
}

}  // namespace mortise::contact
