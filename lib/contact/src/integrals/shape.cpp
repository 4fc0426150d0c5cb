#include "integrals/shape.hpp"

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

}  // namespace

Eigen::Vector4d shape(CellType type, const Plane& at)
{
  const double x = at[0], y = at[1];
  if (type == CellType::line2) return {0.5 * (1 - x), 0.5 * (1 + x), 0, 0};
  if (type == CellType::tri3) return {1 - x - y, x, y, 0};
  return {0.25 * (1 - x) * (1 - y), 0.25 * (1 + x) * (1 - y), 0.25 * (1 + x) * (1 + y), 0.25 * (1 - x) * (1 + y)};
}

Locator::Locator(CellType type, const Few<Plane, 4>& nodes) : type_(type), nodes_(nodes)
{
  Eigen::Matrix2d edges;
  switch (type) {
    case CellType::line2: {
      const Plane half = 0.5 * (nodes[1] - nodes[0]);
      origin_ = 0.5 * (nodes[0] + nodes[1]);
      inverse_ << half.transpose() / half.squaredNorm(), 0, 0;
      return;
    }
    case CellType::tri3:
      origin_ = nodes[0];
      edges << nodes[1] - nodes[0], nodes[2] - nodes[0];
      break;
    default:
      origin_ = 0.25 * (nodes[0] + nodes[1] + nodes[2] + nodes[3]);
      edges << 0.25 * (nodes[1] + nodes[2] - nodes[0] - nodes[3]), 0.25 * (nodes[2] + nodes[3] - nodes[0] - nodes[1]);
      // A parallelogram's map is affine.
      affine_ = (nodes[0] - nodes[1] + nodes[2] - nodes[3]).squaredNorm() < 1e-28 * edges.squaredNorm();
  }
  inverse_ = edges.inverse();
}

Plane Locator::locate(const Plane& x) const
{
  Plane at = inverse_ * (x - origin_);
  if (affine_) return at;
  for (int step = 0; step < 30; ++step) {
    const auto n = shape(CellType::quad4, at);
    const auto g = quad_gradient(at);
    Plane value = Plane::Zero();
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
    for (int i = 0; i < 4; ++i) {
      value += n[i] * nodes_[static_cast<std::size_t>(i)];
      jacobian += nodes_[static_cast<std::size_t>(i)] * g.row(i);
    }
    const Plane change = jacobian.inverse() * (x - value);
    at += change;
    if (change.squaredNorm() < 1e-18) break;  // what is left is its square
    at = at.cwiseMax(-3).cwiseMin(3);         // strays only on badly warped faces
  }
  return at;
}

}  // namespace mortise::contact
