// Integration points on convex polygons and on segments of a line.
#pragma once

#include <vector>

#include "integrals/shape.hpp"
#include "search/small.hpp"

namespace mortise::contact {

/// The common part of two convex quadrilaterals has at most eight corners; badly warped ones may have more.
using Polygon = Few<Plane, 24>;

struct Sample {
  Plane at;
  double weight;
};

/// What a rule has to integrate in the plane: products of linear or bilinear functions of parallelograms have degree 4 at most,
/// those of faces of second order 8, and those of other quadrilaterals are rational.
struct Integrand {
  bool second_order = false;
  /// How far the Jacobian of a quadrilateral varies from its middle to its corners, as a part of it; 0 for parallelograms.
  double variation = 0;
};

/// Twice the area of the triangle 0 a b.
inline double cross(const Plane& a, const Plane& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// Negative if it runs clockwise.
double area_of(const Polygon& polygon);

/// The point of the line from a to b next to x, and that of a convex, counter-clockwise polygon (two ends of a line).
Plane nearest_on(const Plane& a, const Plane& b, const Plane& x);
Plane nearest_in(const Polygon& polygon, const Plane& x);

/// The corners of the convex hull of points, counter-clockwise: their places in `points`.
std::vector<std::size_t> convex_hull(const std::vector<Plane>& points);

/// Replaces `points` by those of a convex, counter-clockwise polygon. Polynomials are integrated exactly on the triangles from
/// its first corner, by the symmetric rules of degree 4 (6 points) and 8 (16) [Strang and Fix 1973; Dunavant, IJNME 21 (1985)];
/// rational functions by 4 x 4 to 9 x 9 Gauss points on each triangle from its centre, to 1e-10 up to a variation of 0.4, which
/// keeps a patch test at rounding.
void sample(const Polygon& polygon, Integrand integrand, std::vector<Sample>& points);

/// Three Gauss points.
void sample(double begin, double end, std::vector<Sample>& points);

}  // namespace mortise::contact
