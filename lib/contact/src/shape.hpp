// Shape functions of faces at any place, and the place of a point in the plane of a face.
#pragma once

#include <Eigen/Core>

#include "mesh/cell.hpp"

namespace mortise::contact {

using Plane = Eigen::Vector2d;  ///< coordinates in an auxiliary plane; on an auxiliary line the second is 0

/// Values of up to four shape functions at reference coordinates: line2 and quad4 in [-1, 1], tri3 in the unit triangle.
Eigen::Vector4d shape(mesh::CellType type, const Plane& at);

/// Reference coordinates of the point `x` in a face whose nodes lie at `nodes` in the plane: the inverse of the isoparametric
/// map.
Plane locate(mesh::CellType type, std::span<const Plane> nodes, const Plane& x);

}  // namespace mortise::contact
