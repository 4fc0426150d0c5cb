// Surfaces of second and third order next to points.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"

namespace mortise::contact {

/// A surface of second order through the origin: at tangents s, t and z = x.normal,
/// 2 z = across s^2 + 2 twist s t + along t^2 + curvature z^2.
struct FittedSurface {
  Point normal;
  double left;  ///< of the heights z of the points, over their squared distances, in the norm
  Point s, t;
  double across, twist, along, curvature;

  /// What is left of the heights of other points.
  double left_of(std::span<const Point> points) const;
};

/// That next to points d, with a normal next to `start`; `start` and all of the heights if there is none. With a `line`: two
/// surfaces which meet in it and have one tangent plane there, with curvatures across that differ.
FittedSurface fit_second_order(const std::vector<Point>& d, const Point& start, const Point* line = nullptr);

/// The normal of a surface whose curvatures change, from that of second order: with b in the tangent plane and the two harmonic
/// cubics h of it, 2 z = d'C d + k z^2 + 2 z b.d + c.h(d) with k = K - b^2 / K, K the larger curvature. Exact on cones. Nothing
/// if it leaves more than a twentieth of the heights.
std::optional<Point> normal_of_third_order(const std::vector<Point>& d, const FittedSurface& second);

/// The same for few points: b lies along the line of least curvature, there are no cubics, and nothing is returned unless it
/// leaves a fifth of what the surface of second order does.
std::optional<Point> normal_of_cone(const std::vector<Point>& d, const FittedSurface& second);

}  // namespace mortise::contact
