#include "fitted_normals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

// Nodes round one that determine a surface of second order, with one to spare.
constexpr std::size_t enough = 6;
// Heights below this part of the distances are rounding.
constexpr double plane_surface = 1e-10;
// How far what the nodes do not determine is held: a slope where it is, a curvature at 0. What they determine is found all the same,
// step by step. Both are the same in all directions: nothing that is found along one leaks into another that is not determined.
constexpr double held_slope = 0.01, held_curvature = 1e-6;
constexpr int steps = 8;
constexpr double settled = 1e-13;
// What a surface of second order may leave of the heights: more is an edge, or scatter.
constexpr double most_left = 0.2;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 5>;

// The surface nodes that share a facet with each, ascending.
class Neighbours {
 public:
  Neighbours(const Side& side, const SurfaceNodes& surface_nodes) : offset_(surface_nodes.all.size() + 1, 0)
  {
    std::vector<std::pair<Local, Local>> pairs;
    for (std::size_t f = 0; f < side.facets.size(); ++f) {
      const auto begin = static_cast<std::size_t>(side.facets.offset[f]), n = side.facets[f].size();
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          if (a != b) pairs.emplace_back(surface_nodes.of_corner[begin + a], surface_nodes.of_corner[begin + b]);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [from, to] : pairs) {
      ++offset_[static_cast<std::size_t>(from) + 1];
      to_.push_back(to);
    }
    for (std::size_t p = 0; p + 1 < offset_.size(); ++p) offset_[p + 1] += offset_[p];
  }

  std::span<const Local> operator[](std::size_t p) const { return {to_.data() + offset_[p], offset_[p + 1] - offset_[p]}; }

  // Those round a surface node, and if `farther` those round these.
  void round(std::size_t p, bool farther, std::vector<Local>& result) const
  {
    result.assign((*this)[p].begin(), (*this)[p].end());
    if (!farther) return;
    std::vector<Local> next;
    for (const Local q : (*this)[p])
      for (const Local r : (*this)[static_cast<std::size_t>(q)])
        if (r != static_cast<Local>(p) && !std::binary_search((*this)[p].begin(), (*this)[p].end(), r)) next.push_back(r);
    std::sort(next.begin(), next.end());
    result.insert(result.end(), next.begin(), std::unique(next.begin(), next.end()));
  }

 private:
  std::vector<std::size_t> offset_;
  std::vector<Local> to_;
};

// The tangents along which the distances are longest and shortest: nodes may lie far closer one way than the other.
std::pair<Point, Point> principal_tangents(const std::vector<Point>& d, const Point& normal)
{
  const Point any = normal.unitOrthogonal(), other = normal.cross(any);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& v : d) {
    const Eigen::Vector2d at(v.dot(any), v.dot(other));
    spread += at * at.transpose() / v.squaredNorm();
  }
  const Eigen::Vector2d axis = dense::plane_eigenpairs(spread).vectors.col(1);
  return {axis[0] * any + axis[1] * other, axis[0] * other - axis[1] * any};
}

// The normal next to `start` of the surface of second order through the origin and the points d; `start` if
// there is none.
Point fitted(const std::vector<Point>& d, const Point& start)
{
  const auto count = static_cast<Eigen::Index>(d.size());
  double length = 0, height = 0;
  for (const auto& v : d) {
    length = std::max(length, v.norm());
    height = std::max(height, std::abs(v.dot(start)) / v.norm());
  }
  Rows rows(count + 5, 5);
  Eigen::VectorXd heights(count + 5);
  Point normal = start;
  double curvature = 0;  // the larger one
  for (int step = 0; step < steps; ++step) {
    const auto [s, t] = principal_tangents(d, normal);
    rows.setZero();
    heights.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Point& v = d[static_cast<std::size_t>(i)];
      const double x = v.dot(s), y = v.dot(t), z = v.dot(normal), square = v.squaredNorm();
      rows.row(i) << x * length, y * length, x * x / 2, x * y, y * y / 2;
      rows.row(i) /= square;
      heights[i] = (z - curvature * z * z / 2) / square;
    }
    Eigen::Matrix<double, 5, 1> scale;
    for (Eigen::Index c = 0; c < 5; ++c) {
      scale[c] = std::max(rows.col(c).norm(), 1e-30 / length);
      rows.col(c) /= scale[c];
      rows(count + c, c) = (c < 2 ? held_slope : c == 3 ? std::sqrt(2.0) * held_curvature : held_curvature) / scale[c];
    }
    const Eigen::Matrix<double, 5, 1> found = dense::least_squares(rows, heights);
    const Eigen::VectorXd left = rows.topRows(count) * found - heights.head(count);
    if (left.norm() > most_left * heights.head(count).norm()) return start;
    const Eigen::Matrix<double, 5, 1> c = found.cwiseQuotient(scale);
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    const double mean = (c[2] + c[4]) / 2, spread = std::hypot((c[2] - c[4]) / 2, c[3]);
    curvature = mean > 0 ? mean + spread : mean - spread;
    normal = (normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() > 2 * height) return start;
    if (slope.norm() < settled) break;
  }
  return (normal - start).norm() > height ? start : normal;
}

}  // namespace

void fit_normals(const Side& side, const SurfaceNodes& means, const std::vector<bool>& border, SurfaceNodes& surface_nodes)
{
  const Neighbours neighbours(side, surface_nodes);
  const auto at = [&](std::size_t p) -> const Point& { return side.points[static_cast<std::size_t>(surface_nodes.all[p].node)]; };
  std::vector<Local> round;
  std::vector<Point> d;
  for (std::size_t p = 0; p < surface_nodes.all.size(); ++p) {
    neighbours.round(p, border[p] || neighbours[p].size() < enough, round);
    d.clear();
    bool plane = true;
    for (const Local q : round) {
      const Point v = at(static_cast<std::size_t>(q)) - at(p);
      if (v.squaredNorm() == 0) continue;
      d.push_back(v);
      plane = plane && std::abs(v.dot(means.all[p].normal)) < plane_surface * v.norm();
    }
    auto& normal = surface_nodes.all[p].normal;
    if (!d.empty()) normal = plane ? means.all[p].normal : fitted(d, normal);
  }
}

}  // namespace mortise::contact
