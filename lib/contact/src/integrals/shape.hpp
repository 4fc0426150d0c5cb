// Shape functions of faces at any place, and the place of a point in the plane of a face.
#pragma once

#include <Eigen/Core>

#include "mesh/cell.hpp"
#include "search/small.hpp"

namespace mortise::contact {

using Plane = Eigen::Vector2d;  ///< coordinates in an auxiliary plane; on an auxiliary line the second is 0

/// Values of up to four shape functions at reference coordinates: line2 and quad4 in [-1, 1], tri3 in the unit triangle.
Eigen::Vector4d shape(mesh::CellType type, const Plane& at);

/// Values of the shape functions of a facet at points of the plane in which its nodes lie at `nodes`: the inverse of the
/// isoparametric map.
class Locator {
 public:
  Locator(mesh::CellType type, const Few<Plane, 4>& nodes);
  Eigen::Vector4d operator()(const Plane& x) const { return shape(type_, locate(x)); }
  /// Reference coordinates.
  Plane locate(const Plane& x) const;

 private:
  mesh::CellType type_;
  Few<Plane, 4> nodes_;
  bool affine_ = true;
  Plane origin_;  // x = origin + inverse^-1 at, of a quadrilateral that is no parallelogram about its centre
  Eigen::Matrix2d inverse_;
};

}  // namespace mortise::contact
