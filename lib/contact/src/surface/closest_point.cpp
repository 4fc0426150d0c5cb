#include "surface/closest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "surface/angle.hpp"

namespace mortise::contact {

namespace {

// The place between two points that is nearest, from 0 to 1.
double along_line(const Point& x, const Point& a, const Point& b)
{
  const double square = (b - a).squaredNorm();
  return square > 0 ? std::clamp((x - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

ClosestPoint closest_of_line(const Point& x, const Point& a, const Point& b, const Point& normal)
{
  const double t = along_line(x, a, b);
  const Point at = a + t * (b - a);
  return {at, (x - at).norm(), (t > 0 && t < 1 ? 2 : 1) * normal};
}

ClosestPoint closest_of_triangle(const Point& x, const Point& a, const Point& b, const Point& c)
{
  const std::array<const Point*, 3> corner{&a, &b, &c};
  const Point across = (b - a).cross(c - a);
  const Point normal = across.normalized();
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k)
    inside = inside && across.dot((*corner[(k + 1) % 3] - *corner[k]).cross(x - *corner[k])) > 0;
  if (inside) {
    const double height = normal.dot(x - a);
    return {x - height * normal, std::abs(height), 2 * std::numbers::pi * normal};
  }
  ClosestPoint best{a, std::numeric_limits<double>::infinity(), normal};
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &from = *corner[k], &to = *corner[(k + 1) % 3], &beyond = *corner[(k + 2) % 3];
    const double t = along_line(x, from, to);
    const Point at = from + t * (to - from);
    const double distance = (x - at).norm();
    if (!(distance < best.distance)) continue;
    double angle = std::numbers::pi;
    if (t == 0) angle = angle_between(to - from, beyond - from);
    if (t == 1) angle = angle_between(from - to, beyond - to);
    best = {at, distance, angle * normal};
  }
  return best;
}

}  // namespace mortise::contact
