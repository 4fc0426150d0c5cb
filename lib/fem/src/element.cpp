#include "fem/element.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "elements/elements.hpp"

namespace mortise::fem {

const Element& element(mesh::CellType type)
{
  static const std::array<Element, 6> table{line2(), tri3(), quad4(), tet4(), hex8(), prism6()};  // in the order of CellType
  return table[static_cast<std::size_t>(type)];
}

Element tabulate(int dimension, int nodes, const std::vector<IntegrationPoint>& points, const Shape& shape)
{
  Element result;
  result.dimension = dimension;
  result.nodes = nodes;
  const auto q = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd values(q, nodes);
  for (Eigen::Index i = 0; i < q; ++i) {
    const auto& point = points[static_cast<std::size_t>(i)];
    Eigen::VectorXd value(nodes);
    Eigen::MatrixXd gradient(nodes, dimension);
    shape(point.at, value, gradient);
    values.row(i) = value.transpose();
    result.weight.push_back(point.weight);
    result.shape.push_back(value);
    result.gradient.push_back(gradient);
  }
  if (q >= nodes)
    result.extrapolation = (values.transpose() * values).ldlt().solve(values.transpose());
  else
    result.extrapolation = Eigen::MatrixXd::Constant(nodes, q, 1.0 / static_cast<double>(q));
  return result;
}

std::vector<IntegrationPoint> gauss2(int dimension)
{
  const double g = 1 / std::sqrt(3.0);
  std::vector<IntegrationPoint> points;
  for (int i = 0; i < 1 << dimension; ++i) {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (int c = 0; c < dimension; ++c) at[c] = (i >> c & 1) != 0 ? g : -g;
    points.push_back({at, 1});
  }
  return points;
}

Shape multilinear(int dimension, const std::vector<Eigen::Vector3d>& corners)
{
  return [=](const Eigen::Vector3d& x, Eigen::VectorXd& value, Eigen::MatrixXd& gradient) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      value[row] = 1;
      gradient.row(row).setOnes();
      for (int c = 0; c < dimension; ++c) {
        const double factor = 0.5 * (1 + corners[i][c] * x[c]);
        value[row] *= factor;
        for (int d = 0; d < dimension; ++d) gradient(row, d) *= c == d ? 0.5 * corners[i][c] : factor;
      }
    }
  };
}

}  // namespace mortise::fem
