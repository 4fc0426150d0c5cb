// The elements by name, and what they share.
#pragma once

#include <functional>

#include "fem/element.hpp"
#include "kernels.hpp"

namespace mortise::fem {

Element line2();
Element tri3();
Element quad4();
Element tet4();
Element hex8();
Element prism6();

/// An integration point in reference coordinates.
struct IntegrationPoint {
  Eigen::Vector3d at;
  double weight;
};

/// Evaluates the n shape functions and their n x d derivatives at a point.
using Shape = std::function<void(const Eigen::Vector3d& at, Eigen::VectorXd& value, Eigen::MatrixXd& gradient)>;

/// The tables of an element; no kernels.
Element tabulate(int dimension, int nodes, const std::vector<IntegrationPoint>& points, const Shape& shape);

/// The whole of an element with n nodes in d dimensions.
template <int n, int d>
Element make_element(const std::vector<IntegrationPoint>& points, const Shape& shape)
{
  Element result = tabulate(d, n, points, shape);
  if constexpr (d > 1) {  // a line is a face only
    result.gradients_in_space = gradients_in_space<n, d>;
    result.stiffness = stiffness_of_cell<n, d>;
  }
  return result;
}

/// Two-point Gauss rule on [-1, 1] in `dimension` directions.
std::vector<IntegrationPoint> gauss2(int dimension);

/// Multilinear shape functions on [-1, 1]^d with the signs of the corners given.
Shape multilinear(int dimension, const std::vector<Eigen::Vector3d>& corners);

}  // namespace mortise::fem
