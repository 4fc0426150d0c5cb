#include "surface/fitted_surface.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

// How far what the nodes do not determine is held: a slope where it is, a curvature at 0. What they determine is found all the
// same, step by step. Both are the same in all directions: nothing that is found along one leaks into another that is not
// determined.
constexpr double held_slope = 0.01, held_curvature = 1e-6;
// The same of what changes curvatures, as a part of what it does to the heights: few nodes tell it from a slope.
constexpr double held_change = 0.1;
constexpr int steps = 8, steps_of_third = 20;
constexpr double settled = 1e-13, settled_third = 1e-10;
// What a surface of second order may leave of the heights: more is an edge, or scatter. And one of third order.
constexpr double most_left = 0.2, most_left_of_third = 0.05;
// What a cone leaves of what a surface of second order leaves.
constexpr double cone_leaves = 0.2;

using Tangents = std::pair<Point, Point>;

// The tangents along which the distances are longest and shortest: nodes may lie far closer one way than the other.
Tangents principal_tangents(const std::vector<Point>& d, const Point& normal)
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
Tangents tangents_of_line(const Point& line, const Point& normal)
{
  const Point along = (line - line.dot(normal) * normal).normalized();
  return {along, normal.cross(along)};
}

// Along the most curvature and the least.
Tangents tangents_of_curvature(const FittedSurface& surface)
{
  const auto [values, vectors] =
      dense::plane_eigenpairs((Eigen::Matrix2d() << surface.across, surface.twist, surface.twist, surface.along).finished());
  const int most = std::abs(values[0]) < std::abs(values[1]) ? 1 : 0;
  const Point s = vectors(0, most) * surface.s + vectors(1, most) * surface.t;
  return {s, surface.normal.cross(s)};
}

double larger_curvature(double across, double twist, double along)
{
  const double mean = (across + along) / 2, spread = std::hypot((across - along) / 2, twist);
  return mean > 0 ? mean + spread : mean - spread;
}

// Scales the columns of the first `count` rows to 1 and adds those that hold the unknowns: two slopes, three curvatures or four,
// and from `first_change` on what changes them. Returns the scales.
Eigen::VectorXd scale_and_hold(Eigen::MatrixXd& rows, Eigen::Index count, Eigen::Index first_change, double length)
{
  Eigen::VectorXd scale(rows.cols());
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    const bool change = c >= first_change;
    scale[c] = std::max(rows.col(c).head(count).norm(), change ? 1e-8 : 1e-30 / length);
    rows.col(c) /= scale[c];
    const double held = c < 2 ? held_slope : c == 3 ? std::sqrt(2.0) * held_curvature : held_curvature;
    rows(count + c, c) = change ? held_change : held / scale[c];
  }
  return scale;
}

double part_left(const Eigen::MatrixXd& rows, const Eigen::VectorXd& found, const Eigen::VectorXd& heights, Eigen::Index count)
{
  return (rows.topRows(count) * found - heights.head(count)).norm() /
         std::max(heights.head(count).norm(), std::numeric_limits<double>::min());
}

double longest(const std::vector<Point>& d)
{
  double length = 0;
  for (const auto& v : d) length = std::max(length, v.norm());
  return length;
}

// The normal of a surface of third order, and what it leaves.
std::pair<Point, double> fit_third_order(const std::vector<Point>& d, const FittedSurface& second, bool cone)
{
  const auto count = static_cast<Eigen::Index>(d.size());
  const Eigen::Index changes = cone ? 1 : 4, columns = 5 + changes;
  const double length = longest(d);
  FittedSurface surface = second;
  std::tie(surface.s, surface.t) = tangents_of_curvature(surface);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(changes);
  Eigen::MatrixXd rows(count + columns, columns);
  Eigen::VectorXd heights(count + columns);
  for (int step = 0; step < steps_of_third; ++step) {
    if (cone && step > 0) {
      const Point before = surface.t;
      std::tie(surface.s, surface.t) = tangents_of_curvature(surface);
      if (surface.t.dot(before) < 0) surface.s *= -1, surface.t *= -1;
    } else {
      std::tie(surface.s, surface.t) = tangents_of_line(surface.s, surface.normal);
    }
    const Point s = surface.s, t = surface.t;
    rows.setZero();
    heights.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Point& v = d[static_cast<std::size_t>(i)];
      const double x = v.dot(s), y = v.dot(t), z = v.dot(surface.normal);
      rows.row(i).head(5) << x * length, y * length, x * x / 2, x * y, y * y / 2;
      if (cone)
        rows(i, 5) = y * (z - surface.along * y * y / 2);
      else
        rows.row(i).tail(4) << x * z, y * z, x * (x * x - 3 * y * y) / length, y * (y * y - 3 * x * x) / length;
      heights[i] = z - surface.curvature * z * z / 2 - rows.row(i).tail(changes).dot(change);
      rows.row(i) /= v.squaredNorm();
      heights[i] /= v.squaredNorm();
    }
    const Eigen::VectorXd scale = scale_and_hold(rows, count, 5, length);
    const Eigen::VectorXd found = dense::least_squares(rows, heights), c = found.cwiseQuotient(scale);
    surface.left = part_left(rows, found, heights, count);
    change += c.tail(changes);
    surface.across = c[2], surface.twist = c[3], surface.along = c[4];
    const double larger = larger_curvature(c[2], c[3], c[4]), square = change.head(cone ? 1 : 2).squaredNorm();
    surface.curvature = larger * larger > square ? larger - square / larger : 0;
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    surface.normal = (surface.normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() < settled_third) break;
  }
  return {surface.normal, surface.left};
}

}  // namespace

double FittedSurface::left_of(std::span<const Point> points) const
{
  double sum = 0, all = 0;
  for (const Point& v : points) {
    const double x = v.dot(s), y = v.dot(t), z = v.dot(normal), weight = 1 / std::pow(v.squaredNorm(), 2);
    sum += weight * std::pow(z - (across * x * x + 2 * twist * x * y + along * y * y + curvature * z * z) / 2, 2);
    all += weight * z * z;
  }
  return all > 0 ? std::sqrt(sum / all) : 0;
}

FittedSurface fit_second_order(const std::vector<Point>& d, const Point& start, const Point* line)
{
  const auto count = static_cast<Eigen::Index>(d.size());
  const FittedSurface none{start, 1, Point::Zero(), Point::Zero(), 0, 0, 0, 0};
  const double length = longest(d);
  double height = 0;
  for (const auto& v : d) height = std::max(height, std::abs(v.dot(start)) / v.norm());
  const Eigen::Index columns = line ? 6 : 5;
  Eigen::MatrixXd rows(count + columns, columns);
  Eigen::VectorXd heights(count + columns);
  FittedSurface result = none;
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
    const Eigen::VectorXd scale = scale_and_hold(rows, count, columns, length);
    const Eigen::VectorXd found = dense::least_squares(rows, heights);
    result.left = part_left(rows, found, heights, count);
    if (!(result.left <= most_left)) return none;
    const Eigen::VectorXd c = found.cwiseQuotient(scale);
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    for (Eigen::Index beyond = 0; beyond + 4 < columns; ++beyond)
      curvature[static_cast<std::size_t>(beyond)] = larger_curvature(c[2], c[3], c[4 + beyond]);
    result.s = s, result.t = t;
    result.across = c[2], result.twist = c[3], result.along = c[4], result.curvature = curvature[0];
    normal = (normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() > 2 * height) return none;
    if (slope.norm() < settled) break;
  }
  return (normal - start).norm() > height ? none : result;
}

std::optional<Point> normal_of_third_order(const std::vector<Point>& d, const FittedSurface& second)
{
  const auto [normal, left] = fit_third_order(d, second, false);
  return left < most_left_of_third ? std::optional(normal) : std::nullopt;
}

std::optional<Point> normal_of_cone(const std::vector<Point>& d, const FittedSurface& second)
{
  const auto [normal, left] = fit_third_order(d, second, true);
  return left < cone_leaves * second.left_of(d) ? std::optional(normal) : std::nullopt;
}

}  // namespace mortise::contact
