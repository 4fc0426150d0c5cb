// Where two faces lie opposite each other: integration points on the common part of their projections.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "shape.hpp"

namespace mortise::contact {

/// A face with its nodes in space.
struct FaceGeometry {
  mesh::CellType type;
  std::vector<Point> nodes;

  Point centre() const;
  Point normal() const;  ///< unit, at the centre
  double size() const;   ///< longest distance between two nodes
  double area() const;   ///< in the plane of the centre
};

/// An integration point: its weight in the auxiliary plane (2D: line) and both faces' shape functions there.
struct OverlapPoint {
  double weight;
  Eigen::Vector4d secondary, primary;
};

/// The secondary face's auxiliary plane through its centre is where both are projected along its normal and clipped [Puso and
/// Laursen, CMAME 193 (2004); Popp et al., IJNME 83 (2010)]. Empty if the faces do not look at each other, or lie farther apart
/// than `reach` (the distance is taken at the centre of the common part).
std::vector<OverlapPoint> overlap(const FaceGeometry& secondary, const FaceGeometry& primary, double reach);

/// Where the line through `from` along the unit vector `direction` meets a face: the distance along it and the face's shape
/// functions there.
struct Hit {
  bool found = false;
  double distance = 0;
  Eigen::Vector4d shape = Eigen::Vector4d::Zero();
};
Hit shoot(const Point& from, const Point& direction, const FaceGeometry& face);

}  // namespace mortise::contact
