#include "mesh/inverse_map.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "mesh/shape_functions.hpp"

namespace mortise::mesh {

namespace {

constexpr int most_steps = 40;
constexpr double longest_step = 1, far = 10;  // in reference coordinates

// The nearest place of the reference cell, nearly.
Eigen::Vector3d drawn_in(CellType type, Eigen::Vector3d at)
{
  const auto into_simplex = [&](int dimension) {
    auto part = at.head(dimension);
    part = part.cwiseMax(0.0);
    if (const double sum = part.sum(); sum > 1) part /= sum;
  };
  switch (first_order(type)) {
    case CellType::tri3:
      into_simplex(2);
      break;
    case CellType::tet4:
      into_simplex(3);
      break;
    case CellType::prism6:
      into_simplex(2);
      at[2] = std::clamp(at[2], -1.0, 1.0);
      break;
    default:
      at = at.cwiseMax(-1.0).cwiseMin(1.0);
  }
  at.tail(3 - dimension(type)).setZero();
  return at;
}

}  // namespace

CellPlace find_in_cell(CellType type, std::span<const Point> nodes, const Point& x)
{
  const auto& shape = shape_functions(type);
  const int d = dimension(type), corners = corner_count(type);
  Eigen::VectorXd value(shape.count());
  Eigen::MatrixXd gradient;
  const auto at_reference = [&](const Eigen::Vector3d& reference, Eigen::MatrixXd* slope) {
    shape.evaluate(reference, value, slope);
    Point at = Point::Zero();
    for (Eigen::Index i = 0; i < value.size(); ++i) at += value[i] * nodes[static_cast<std::size_t>(i)];
    return at;
  };
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();
  for (int k = 0; k < corners; ++k) reference += shape.nodes()[static_cast<std::size_t>(k)] / corners;
  for (int step = 0; step < most_steps && reference.norm() < far; ++step) {
    const Point rest = x - at_reference(reference, &gradient);
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();  // in a plane the third direction is z
    jacobian.leftCols(d).setZero();
    for (Eigen::Index i = 0; i < value.size(); ++i) jacobian.leftCols(d) += nodes[static_cast<std::size_t>(i)] * gradient.row(i);
    Eigen::Vector3d change = jacobian.partialPivLu().solve(rest);
    change.tail(3 - d).setZero();
    if (!change.allFinite()) break;
    if (const double length = change.norm(); length > longest_step) change *= longest_step / length;
    reference += change;
    if (change.norm() < 1e-13) break;
  }
  reference = drawn_in(type, reference);
  return {reference, (x - at_reference(reference, nullptr)).norm()};
}

}  // namespace mortise::mesh
