#include "shape.hpp"

#include <Eigen/Dense>

namespace mortise::contact {

using mesh::CellType;

namespace {

Eigen::Matrix<double, 4, 2> quad_gradient(const Plane& at)
{
  const double x = at[0], y = at[1];
  Eigen::Matrix<double, 4, 2> g;
  g << -(1 - y), -(1 - x), 1 - y, -(1 + x), 1 + y, 1 + x, -(1 + y), 1 - x;
  return 0.25 * g;
}

Plane locate_in_quad(std::span<const Plane> nodes, const Plane& x)
{
  // A parallelogram's map is affine.
  const Plane edge = 0.5 * (nodes[1] - nodes[0]), next = 0.5 * (nodes[3] - nodes[0]);
  if ((nodes[0] - nodes[1] + nodes[2] - nodes[3]).squaredNorm() < 1e-28 * (edge.squaredNorm() + next.squaredNorm())) {
    Eigen::Matrix2d edges;
    edges << edge, next;
    return edges.inverse() * (x - 0.5 * (nodes[0] + nodes[2]));
  }
  Plane at = Plane::Zero();
  for (int step = 0; step < 30; ++step) {
    const auto n = shape(CellType::quad4, at);
    const auto g = quad_gradient(at);
    Plane value = Plane::Zero();
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
    for (int i = 0; i < 4; ++i) {
      value += n[i] * nodes[static_cast<std::size_t>(i)];
      jacobian += nodes[static_cast<std::size_t>(i)] * g.row(i);
    }
    const Plane change = jacobian.inverse() * (x - value);
    at += change;
    if (change.squaredNorm() < 1e-18) break;  // what is left is its square
    at = at.cwiseMax(-3).cwiseMin(3);         // strays only on badly warped faces
  }
  return at;
}

}  // namespace

Eigen::Vector4d shape(CellType type, const Plane& at)
{
  const double x = at[0], y = at[1];
  if (type == CellType::line2) return {0.5 * (1 - x), 0.5 * (1 + x), 0, 0};
  if (type == CellType::tri3) return {1 - x - y, x, y, 0};
  return {0.25 * (1 - x) * (1 - y), 0.25 * (1 + x) * (1 - y), 0.25 * (1 + x) * (1 + y), 0.25 * (1 - x) * (1 + y)};
}

Plane locate(CellType type, std::span<const Plane> nodes, const Plane& x)
{
  if (type == CellType::line2) {
    const Plane edge = nodes[1] - nodes[0];
    return {2 * (x - nodes[0]).dot(edge) / edge.squaredNorm() - 1, 0};
  }
  if (type == CellType::quad4) return locate_in_quad(nodes, x);
  Eigen::Matrix2d edges;
  edges << nodes[1] - nodes[0], nodes[2] - nodes[0];
  return edges.inverse() * (x - nodes[0]);
}

}  // namespace mortise::contact
