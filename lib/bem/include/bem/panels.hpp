// The surface of a body as panels, the boundary elements: flat triangles in space, straight lines in a plane. Displacements are
// linear on each and continuous, tractions constant.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace mortise::bem {

/// Of space (D = 3) or of the plane z = 0 (D = 2). Vectors at nodes and on panels have D components: component D * node + i.
template <int D>
struct PanelsIn {
  std::vector<Point> points;
  std::vector<std::array<Local, D>> corners;  ///< counter-clockwise, seen from outside; lines have the inside at their left
  std::vector<Point> normal;                  ///< unit, outward
  std::vector<double> area;                   ///< of lines the length

  Eigen::Index size() const { return static_cast<Eigen::Index>(corners.size()); }       ///< m, panels
  Eigen::Index node_count() const { return static_cast<Eigen::Index>(points.size()); }  ///< n, nodes
  /// The k-th corner of a panel, k < D.
  const Point& corner(std::size_t panel, int k) const
  {
    return points[static_cast<std::size_t>(corners[panel][static_cast<std::size_t>(k)])];
  }
  /// The mean of its corners.
  Point middle(std::size_t panel) const
  {
    Point sum = corner(panel, 0);
    for (int k = 1; k < D; ++k) sum += corner(panel, k);
    return sum / D;
  }
  /// Tangential gradient of the function that is 1 in the k-th corner of a panel and 0 in the others.
  Point gradient(std::size_t panel, int k) const;
};

template <>
Point PanelsIn<2>::gradient(std::size_t panel, int k) const;
template <>
Point PanelsIn<3>::gradient(std::size_t panel, int k) const;

using Panels = PanelsIn<3>;
using PlanePanels = PanelsIn<2>;

/// The triangles, from their corners. Throws Error(bad_input) if one has no area, if an edge is not run along by as many
/// triangles in one direction as in the other, or if the normals point inward.
Panels make_panels(std::vector<Point> points, std::vector<std::array<Local, 3>> corners);

/// The lines, from their ends. Throws Error(bad_input) if one has no length, if not as many lines begin as end in a node, or if
/// the normals point inward.
PlanePanels make_panels(std::vector<Point> points, std::vector<std::array<Local, 2>> corners);

/// The panels of a skin (partition::Subdomain::skin): the cells of `mesh`, of type tri3, or line2 in a plane. Throws as the
/// above.
template <int D = 3>
PanelsIn<D> make_panels(const mesh::Mesh& mesh);
template <>
PanelsIn<2> make_panels(const mesh::Mesh& mesh);
template <>
PanelsIn<3> make_panels(const mesh::Mesh& mesh);

/// The first D components of a vector, and a vector of D components in space.
template <int D>
Eigen::Matrix<double, D, 1> flattened(const Point& v)
{
  return v.head<D>();
}
template <int D, class Vector>
Point lifted(const Vector& v)
{
  Point result = Point::Zero();
  result.head<D>() = v;
  return result;
}

/// A field that is linear in space, u = offset + gradient * (x - origin), at the nodes: unknown D * node + component.
template <int D>
Eigen::VectorXd linear_field(const PanelsIn<D>& panels, const Point& offset, const Eigen::Matrix3d& gradient,
                             const Point& origin);

}  // namespace mortise::bem
