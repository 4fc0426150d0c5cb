// The surface of a body as flat triangles, the boundary elements: displacements are linear on each and continuous, tractions
// constant.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace mortise::bem {

struct Panels {
  std::vector<Point> points;
  std::vector<std::array<Local, 3>> corners;  ///< counter-clockwise, seen from outside
  std::vector<Point> normal;                  ///< unit, outward
  std::vector<double> area;

  Eigen::Index size() const { return static_cast<Eigen::Index>(corners.size()); }
  Eigen::Index node_count() const { return static_cast<Eigen::Index>(points.size()); }
  const Point& corner(std::size_t panel, int k) const
  {
    return points[static_cast<std::size_t>(corners[panel][static_cast<std::size_t>(k)])];
  }
  /// Surface gradient of the function that is 1 in the k-th corner of a panel and 0 in the others.
  Point gradient(std::size_t panel, int k) const;
};

/// The triangles, from their corners. Throws Error(bad_input) if one has no area, if an edge is not run along by as many
/// triangles in one direction as in the other, or if the normals point inward.
Panels make_panels(std::vector<Point> points, std::vector<std::array<Local, 3>> corners);

/// The skin that `mesh` consists of: cells of type tri3.
Panels make_panels(const mesh::Mesh& mesh);

/// A field that is linear in space, u = offset + gradient * (x - origin), at the nodes: unknown 3 * node + component.
Eigen::VectorXd linear_field(const Panels& panels, const Point& offset, const Eigen::Matrix3d& gradient, const Point& origin);

}  // namespace mortise::bem
