// Shape function gradients of one cell in space, shared by stiffness, loads and stresses.
#pragma once

#include <Eigen/Dense>

#include "fem/element.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// Coordinates of the nodes of a cell, n x d.
inline Eigen::MatrixXd coordinates(const mesh::Mesh& mesh, std::span<const Local> nodes, int dimension)
{
  Eigen::MatrixXd x(static_cast<Eigen::Index>(nodes.size()), dimension);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    x.row(static_cast<Eigen::Index>(i)) = mesh.points[static_cast<std::size_t>(nodes[i])].head(dimension).transpose();
  return x;
}

/// Gradients by the space coordinates at integration point q, n x d, and the volume that the point stands for.
struct SpaceGradient {
  Eigen::MatrixXd gradient;
  double volume;
};
inline SpaceGradient space_gradient(const Element& element, const Eigen::MatrixXd& x, std::size_t q)
{
  const Eigen::MatrixXd jacobian = x.transpose() * element.gradient[q];  // dx / dxi
  return {element.gradient[q] * jacobian.inverse(), jacobian.determinant() * element.weight[q]};
}

}  // namespace mortise::fem
