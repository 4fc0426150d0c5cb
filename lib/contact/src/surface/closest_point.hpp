// The place of a facet that is nearest to a point.
#pragma once

#include <algorithm>

#include "integrals/overlap.hpp"

namespace mortise::contact {

/// The nearest place of a facet. A quadrilateral counts as the two triangles on either side of its first diagonal.
struct ClosestPoint {
  Point at;
  double distance;
  /// Normal of the triangle or line, times the angle that it fills at the place: 2 pi inside, pi on an edge (lines: 2 and 1).
  Point normal;
};

/// Where nothing was found within `reach`, the distance to look within next: four times as far, at most `largest`. After 0, the
/// size of faces that a load has pressed flat, `largest`.
inline double farther(double reach, double largest)
{
  return reach > 0 ? std::min(4 * reach, largest) : largest;
}

/// Calls use(ClosestPoint) for each triangle, or the line, of a facet that is not collapsed.
template <class Use>
void closest_points(const Point& x, const FaceGeometry& facet, const Use& use);

ClosestPoint closest_of_line(const Point& x, const Point& a, const Point& b, const Point& normal);
ClosestPoint closest_of_triangle(const Point& x, const Point& a, const Point& b, const Point& c);

template <class Use>
void closest_points(const Point& x, const FaceGeometry& facet, const Use& use)
{
  const auto& n = facet.nodes;
  const auto triangle = [&](std::size_t i, std::size_t j, std::size_t k) {
    if ((n[j] - n[i]).cross(n[k] - n[i]).squaredNorm() > 0) use(closest_of_triangle(x, n[i], n[j], n[k]));
  };
  if (n.size() == 2) {
    if (n[0] != n[1]) use(closest_of_line(x, n[0], n[1], facet.normal()));
    return;
  }
  triangle(0, 1, 2);
  if (n.size() == 4) triangle(0, 2, 3);
}

}  // namespace mortise::contact
