// Where the other side comes nearest between the nodes of the secondary side.
//
// A contact narrower than a face of the secondary side, as of a roller on a plate, touches between nodes at which the gap is
// wide: rows at the nodes would see nothing of it. The multiplier of the node that is next to such a place moves there, and its
// gap and its direction are those of the place.
#pragma once

#include <vector>

#include "surface/side.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

class OverFacets;
class Rays;

/// The place near a surface node where the gap is least.
struct NearestPoint {
  bool found = false;                               ///< there is one, and no other node is nearer to it
  Point shift = Point::Zero();                      ///< the tangential step to it; zero where the node is that place
  std::size_t facet = 0;                            ///< where it lies, of the secondary side,
  Eigen::Vector4d shape = Eigen::Vector4d::Zero();  ///< and the facet's shape functions there
  bool moved() const { return !shift.isZero(0); }
};

/// Of each surface node: along its normal the smooth surfaces are parallel there, n + m = 0 with the normals n and m of both
/// sides. Newton's method, its matrix the least squares' fit to n + m at the nodes round, else at those of one facet, as on bumps
/// little wider than that; directions in which the sides are curved alike, to 0.3 of their curvature, count as parallel. On edges
/// of the border, where both sides may end in a plane of symmetry, the same along the edge. First, where a convex edge of the
/// primary side lies between nodes, that. Of the nodes of `faces` alone.
std::vector<NearestPoint> nearest_points(const Side& secondary, const SurfaceNodes& surface_nodes,
                                         const std::vector<std::size_t>& faces, Rays& rays, OverFacets& over);

}  // namespace mortise::contact
