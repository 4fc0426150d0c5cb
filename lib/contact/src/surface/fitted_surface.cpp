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
constexpr double converged = 1e-13, converged_third = 1e-10;
// What a surface of second order may leave of the heights: more is an edge, or scatter. And one of third order.
constexpr double most_left = 0.2, most_left_of_third = 0.05;
// What a cone leaves of what a surface of second order leaves.
constexpr double cone_leaves = 0.2;
// The least eigenvalue of the normal equations, their diagonal being 1, at which nodes determine a surface of third order, and a
// cone: nodes in two rows do not.
constexpr double determines_third = 5e-4, determines_cone = 5e-3;
// How far the normal turns at most, over the steepest line to a node.
constexpr double most_turn = 0.25;

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

// How far an unknown is held: two slopes, then curvatures, of which the third counts twice in the matrix.
double held_back(Eigen::Index c)
{
  return c < 2 ? held_slope : c == 3 ? std::sqrt(2.0) * held_curvature : held_curvature;
}

// What a column that is nothing is scaled by.
double smallest(bool change, double length)
{
  return change ? 1e-8 : 1e-30 / length;
}

double longest(const std::vector<Point>& d)
{
  double length = 0;
  for (const auto& v : d) length = std::max(length, v.norm());
  return length;
}

// The steepest line to a node.
double steepest(const std::vector<Point>& d, const Point& normal)
{
  double height = 0;
  for (const auto& v : d) height = std::max(height, std::abs(v.dot(normal)) / v.norm());
  return height;
}

constexpr int most_unknowns = 9;
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_unknowns, 1>;
using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_unknowns, most_unknowns>;

// The normal of a surface of third order, and what it leaves: all where the nodes do not determine one.
std::pair<Point, double> fit_third_order(const std::vector<Point>& d, const FittedSurface& second, bool cone)
{
  const Eigen::Index changes = cone ? 1 : 4, columns = 5 + changes;
  const double length = longest(d);
  FittedSurface surface = second;
  std::tie(surface.s, surface.t) = tangents_of_curvature(surface);
  Unknowns change = Unknowns::Zero(changes);
  Gram gram;
  for (int step = 0; step < steps_of_third; ++step) {
    if (cone && step > 0) {
      const Point before = surface.t;
      std::tie(surface.s, surface.t) = tangents_of_curvature(surface);
      if (surface.t.dot(before) < 0) surface.s *= -1, surface.t *= -1;
    } else {
      std::tie(surface.s, surface.t) = tangents_of_line(surface.s, surface.normal);
    }
    const Point s = surface.s, t = surface.t;
    gram.setZero(columns, columns);
    Unknowns right = Unknowns::Zero(columns), row(columns);
    double heights = 0;  // squared
    for (const Point& v : d) {
      const double x = v.dot(s), y = v.dot(t), z = v.dot(surface.normal), square = v.squaredNorm();
      row.head(5) << x * length, y * length, x * x / 2, x * y, y * y / 2;
      if (cone)
        row[5] = y * (z - surface.along * y * y / 2);
      else
        row.tail(4) << x * z, y * z, x * (x * x - 3 * y * y) / length, y * (y * y - 3 * x * x) / length;
      const double height = (z - surface.curvature * z * z / 2 - row.tail(changes).dot(change)) / square;
      row /= square;
      gram.noalias() += row * row.transpose();
      right += height * row;
      heights += height * height;
    }
    Unknowns scale(columns), held(columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      scale[c] = std::max(std::sqrt(gram(c, c)), smallest(c >= 5, length));
      held[c] = c < 5 ? held_back(c) / scale[c] : held_change;
    }
    gram = scale.cwiseInverse().asDiagonal() * gram * scale.cwiseInverse().asDiagonal();
    right = right.cwiseQuotient(scale);
    Gram all = gram;
    all.diagonal() += held.cwiseAbs2();
    const Unknowns found = dense::solve_symmetric(all, right), c = found.cwiseQuotient(scale);
    surface.left = std::sqrt(std::max(heights - 2 * found.dot(right) + found.dot(gram * found), 0.0) /
                             std::max(heights, std::numeric_limits<double>::min()));
    change += c.tail(changes);
    surface.across = c[2], surface.twist = c[3], surface.along = c[4];
    const double larger = larger_curvature(c[2], c[3], c[4]), square = change.head(cone ? 1 : 2).squaredNorm();
    surface.curvature = larger * larger > square ? larger - square / larger : 0;
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    surface.normal = (surface.normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() < converged_third) break;
  }
  const bool determined = dense::symmetric_eigenpairs(gram).values[0] > (cone ? determines_cone : determines_third);
  const bool near = (surface.normal - second.normal).norm() < most_turn * steepest(d, second.normal);
  return {surface.normal, determined && near ? surface.left : 1.0};
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
  const double height = steepest(d, start);
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
    Eigen::VectorXd scale(columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      scale[c] = std::max(rows.col(c).norm(), smallest(false, length));
      rows.col(c) /= scale[c];
      rows(count + c, c) = held_back(c) / scale[c];
    }
    const Eigen::VectorXd found = dense::least_squares(rows, heights);
    const Eigen::VectorXd left = rows.topRows(count) * found - heights.head(count);
    result.left = left.norm() / std::max(heights.head(count).norm(), std::numeric_limits<double>::min());
    if (!(result.left <= most_left)) return none;
    const Eigen::VectorXd c = found.cwiseQuotient(scale);
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    for (Eigen::Index beyond = 0; beyond + 4 < columns; ++beyond)
      curvature[static_cast<std::size_t>(beyond)] = larger_curvature(c[2], c[3], c[4 + beyond]);
    result.s = s, result.t = t;
    result.across = c[2], result.twist = c[3], result.along = c[4], result.curvature = curvature[0];
    normal = (normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() > 2 * height) return none;
    if (slope.norm() < converged) break;
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
