#include "fem/element.hpp"

#include <Eigen/Dense>
#include <array>

#include "base/dense.hpp"
#include "kernels.hpp"
#include "mesh/shape_functions.hpp"
#include "rules.hpp"

namespace mortise::fem {

namespace {

// Fits the shape functions of the first-order cell of that shape to the values at the integration points: of a cell of second
// order the stresses are one order more exact where this linear part of them is taken [Barlow, IJNME 10 (1976)].
Eigen::MatrixXd extrapolation(mesh::CellType type, const std::vector<IntegrationPoint>& points)
{
  const auto& linear = mesh::shape_functions(mesh::first_order(type));
  const auto& nodes = mesh::shape_functions(type).nodes();
  const auto q = static_cast<Eigen::Index>(points.size()), n = static_cast<Eigen::Index>(nodes.size());
  if (q < linear.count()) return Eigen::MatrixXd::Constant(n, q, 1.0 / static_cast<double>(q));
  Eigen::MatrixXd at_points(linear.count(), q), at_nodes(linear.count(), n);
  Eigen::VectorXd weight(q);
  for (Eigen::Index i = 0; i < q; ++i) {
    linear.evaluate(points[static_cast<std::size_t>(i)].at, at_points.col(i));
    weight[i] = points[static_cast<std::size_t>(i)].weight;
  }
  for (Eigen::Index i = 0; i < n; ++i) linear.evaluate(nodes[static_cast<std::size_t>(i)], at_nodes.col(i));
  const Eigen::MatrixXd weighted = at_points * weight.asDiagonal();
  return at_nodes.transpose() * dense::solve_symmetric(weighted * at_points.transpose(), weighted);
}

template <int n, int d>
Element make(mesh::CellType type, const std::vector<IntegrationPoint>& points)
{
  Element result;
  result.dimension = d;
  result.nodes = n;
  const auto& functions = mesh::shape_functions(type);
  for (const auto& point : points) {
    result.weight.push_back(point.weight);
    result.point.push_back(point.at);
    functions.evaluate(point.at, result.shape.emplace_back(n), &result.gradient.emplace_back());
  }
  result.extrapolation = extrapolation(type, points);
  Eigen::VectorXd at_centre(n);
  functions.evaluate(Eigen::Vector3d::Zero(), at_centre, &result.centre_gradient);
  if constexpr (d > 1) {  // a line is a face only
    result.gradients_in_space = gradients_in_space<n, d>;
    result.stiffness = stiffness_of_cell<n, d>;
    if constexpr (n == 1 << d && (d == 2 || d == 3))
      if (type == mesh::CellType::quad4 || type == mesh::CellType::hex8)
        result.stiffness_with_modes = stiffness_of_cell<n + d, d>;
  }
  return result;
}

template <int n, int d>
Element make(mesh::CellType type)
{
  return make<n, d>(type, integration_rule(type));
}

}  // namespace

const Element& element(mesh::CellType type, Kinematics kinematics)
{
  using enum mesh::CellType;
  static const Element ring_of_tri3 = make<3, 2>(tri3, integration_rule(tri6));
  if (type == tri3 && kinematics == Kinematics::axisymmetric) return ring_of_tri3;
  static const std::array<Element, mesh::cell_types> table{
      make<2, 1>(line2),  make<3, 2>(tri3),   make<4, 2>(quad4),  make<4, 3>(tet4),     make<8, 3>(hex8),
      make<6, 3>(prism6), make<3, 1>(line3),  make<6, 2>(tri6),   make<8, 2>(quad8),    make<9, 2>(quad9),
      make<10, 3>(tet10), make<20, 3>(hex20), make<27, 3>(hex27), make<15, 3>(prism15), make<18, 3>(prism18)};
  return table[static_cast<std::size_t>(type)];  // in the order of CellType
}

}  // namespace mortise::fem
