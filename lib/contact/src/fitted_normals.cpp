#include "fitted_normals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

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

// Where it leaves more than this, it may be two, and is if these leave as little as that, and so much less. In a row of faces beside
// the line in which a cylinder runs into a fillet they leave 0.12 to 0.16, in the line 0.01 to 0.04.
constexpr double of_one_surface = 0.05, of_two = 0.06, explained = 0.25;
// Cosine: lines from node to node go on as straight as this.
constexpr double straight = -0.9;
constexpr std::size_t enough_for_two = 9;

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

// Along a line and across.
std::pair<Point, Point> tangents_of_line(const Point& line, const Point& normal)
{
  const Point along = (line - line.dot(normal) * normal).normalized();
  return {along, normal.cross(along)};
}

// A surface of second order through the origin.
struct Fitted {
  Point normal;
  double left;                     // of the heights of the points
  Point s, t;                      // 2 z = across s^2 + 2 twist s t + along t^2 + curvature z^2
  double across, twist, along, curvature;

  // The same of other points.
  double left_of(std::span<const Point> points) const
  {
    double sum = 0, all = 0;
    for (const Point& v : points) {
      const double x = v.dot(s), y = v.dot(t), z = v.dot(normal), weight = 1 / std::pow(v.squaredNorm(), 2);
      sum += weight * std::pow(z - (across * x * x + 2 * twist * x * y + along * y * y + curvature * z * z) / 2, 2);
      all += weight * z * z;
    }
    return all > 0 ? std::sqrt(sum / all) : 0;
  }
};

// The one next to points d, with a normal next to `start`; `start` and all of the heights if there is none. With a `line`: two surfaces
// which meet in it and have one tangent plane there, with curvatures across that differ.
Fitted fitted(const std::vector<Point>& d, const Point& start, const Point* line = nullptr)
{
  const auto count = static_cast<Eigen::Index>(d.size());
  const Fitted none{start, 1, Point::Zero(), Point::Zero(), 0, 0, 0, 0};
  double length = 0, height = 0;
  for (const auto& v : d) {
    length = std::max(length, v.norm());
    height = std::max(height, std::abs(v.dot(start)) / v.norm());
  }
  const Eigen::Index columns = line ? 6 : 5;
  Eigen::MatrixXd rows(count + columns, columns);
  Eigen::VectorXd heights(count + columns);
  Fitted result = none;
  Point& normal = result.normal;
  std::array<double, 2> curvature{0, 0};  // the larger one, on each side of the line
  for (int step = 0; step < steps; ++step) {
    const auto [s, t] = line ? tangents_of_line(*line, normal) : principal_tangents(d, normal);
    rows.setZero();
    heights.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Point& v = d[static_cast<std::size_t>(i)];
      const double x = v.dot(s), y = v.dot(t), z = v.dot(normal), square = v.squaredNorm();
      const int beyond = line && y > 0 ? 1 : 0;
      rows.row(i).head(4) << x * length, y * length, x * x / 2, x * y;
      rows(i, 4 + beyond) = y * y / 2;
      rows.row(i) /= square;
      heights[i] = (z - curvature[static_cast<std::size_t>(beyond)] * z * z / 2) / square;
    }
    Eigen::VectorXd scale(columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      scale[c] = std::max(rows.col(c).norm(), 1e-30 / length);
      rows.col(c) /= scale[c];
      rows(count + c, c) = (c < 2 ? held_slope : c == 3 ? std::sqrt(2.0) * held_curvature : held_curvature) / scale[c];
    }
    const Eigen::VectorXd found = dense::least_squares(rows, heights);
    const Eigen::VectorXd left = rows.topRows(count) * found - heights.head(count);
    result.left = left.norm() / std::max(heights.head(count).norm(), std::numeric_limits<double>::min());
    if (!(result.left <= most_left)) return none;
    const Eigen::VectorXd c = found.cwiseQuotient(scale);
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    for (Eigen::Index beyond = 0; beyond + 4 < columns; ++beyond) {
      const double mean = (c[2] + c[4 + beyond]) / 2, spread = std::hypot((c[2] - c[4 + beyond]) / 2, c[3]);
      curvature[static_cast<std::size_t>(beyond)] = mean > 0 ? mean + spread : mean - spread;
    }
    result.s = s, result.t = t;
    result.across = c[2], result.twist = c[3], result.along = c[4], result.curvature = curvature[0];
    normal = (normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() > 2 * height) return none;
    if (slope.norm() < settled) break;
  }
  return (normal - start).norm() > height ? none : result;
}

// Where one surface leaves much: the two that meet in one of the lines from node to node through the origin, if they explain it.
// `near`: how many of d, the first ones, are the nodes next to it. At a `border` lines may end.
std::optional<Point> of_two_surfaces(const std::vector<Point>& d, std::size_t near, bool border, const Point& start)
{
  if (d.size() < enough_for_two) return std::nullopt;
  std::optional<Point> best;
  double least = std::min(explained * fitted(d, start).left, of_two);
  const auto attempt = [&](const Point& line) {
    if (const Fitted two = fitted(d, start, &line); two.left < least) {
      least = two.left;
      best = two.normal;
    }
  };
  for (std::size_t a = 0; a < near; ++a) {
    if (border) attempt(d[a]);
    for (std::size_t b = 0; b < a; ++b)
      if (d[a].dot(d[b]) < straight * d[a].norm() * d[b].norm())
        attempt((d[a].normalized() - d[b].normalized()).normalized());
  }
  return best;
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
    if (d.empty()) continue;
    if (plane) {
      normal = means.all[p].normal;
      continue;
    }
    const Fitted one = fitted(d, normal);
    neighbours.round(p, true, round);
    d.clear();
    std::size_t near = 0;
    for (std::size_t i = 0; i < round.size(); ++i) {
      const Point v = at(static_cast<std::size_t>(round[i])) - at(p);
      if (v.squaredNorm() == 0) continue;
      d.push_back(v);
      if (i < neighbours[p].size()) near = d.size();
    }
    std::optional<Point> two;
    if (one.left == 1 || one.left_of(d) > of_one_surface) two = of_two_surfaces(d, near, border[p], normal);
    normal = two.value_or(one.normal);
  }
}

}  // namespace mortise::contact
