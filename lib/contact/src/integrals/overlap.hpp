// Where two faces lie opposite each other: integration points on the common part of their projections.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "integrals/quadrature.hpp"
#include "integrals/shape.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// Cosine: faces whose normals enclose less than about 110 degrees do not look at each other.
inline constexpr double opposed = -0.35;

/// A facet, that is a face of first order, with its nodes in space.
struct FaceGeometry {
  mesh::CellType type;
  Few<Point, 4> nodes;

  Point centre() const;
  Point normal() const;  ///< unit, at the centre
  double size() const;   ///< longest distance between two nodes
  double area() const;   ///< in the plane of the centre
};

/// The corners of a face of a surface.
FaceGeometry corners_of(const mesh::Surface& surface, std::size_t face);

/// An auxiliary plane; in 2D `first` runs along the line and `second` is zero.
struct Frame {
  Point origin, first, second, normal;
  Plane project(const Point& x) const { return {(x - origin).dot(first), (x - origin).dot(second)}; }
  double height(const Point& x) const { return (x - origin).dot(normal); }
};

/// The plane of a facet through its centre.
Frame frame_of(const FaceGeometry& face);

/// An integration point: its weight and place in the auxiliary plane (2D: line) and both facets' shape functions there.
struct OverlapPoint {
  double weight;
  Plane at;
  Eigen::Vector4d secondary, primary;
};

struct Overlap {
  Frame frame;
  std::vector<OverlapPoint> points;
  Polygon common;               ///< of the two projections; on a line its two ends
  std::vector<Sample> samples;  ///< for the work on it
  Point middle;                 ///< of the common part, on the secondary facet
  double distance;              ///< from there to the primary one, along the normal of the frame; negative: it lies behind
};

/// The secondary facet's auxiliary plane through its centre is where both are projected along its normal and clipped [Puso and
/// Laursen, CMAME 193 (2004); Popp et al., IJNME 83 (2010)]. False if the faces do not look at each other, or lie farther apart
/// than `reach` (the distance is taken at the centre of the common part). The rule is exact for products of the shape functions
/// of parallelograms, or of faces of second order if `second_order`. `result` may be used again and again.
bool overlap(const FaceGeometry& secondary, const FaceGeometry& primary, double reach, bool second_order, Overlap& result);

/// Where the line through `from` along the unit vector `direction` meets a face: the distance along it and the face's shape
/// functions there.
struct Hit {
  bool found = false;
  double distance = 0;
  Eigen::Vector4d shape = Eigen::Vector4d::Zero();
  Frame frame;  ///< the line is its normal through its origin
};
/// A line that passes the face's border by up to `margin` (in shape functions) hits the face continued.
Hit shoot(const Point& from, const Point& direction, const FaceGeometry& face, double margin = 1e-6);

}  // namespace mortise::contact
