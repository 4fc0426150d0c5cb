// The elements by name, and what they share.
#pragma once

#include <functional>

#include "fem/element.hpp"

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

/// Tabulates shape functions, which return n values and n x d derivatives, at the points.
using Shape = std::function<void(const Eigen::Vector3d& at, Eigen::VectorXd& value, Eigen::MatrixXd& gradient)>;
Element tabulate(int dimension, int nodes, const std::vector<IntegrationPoint>& points, const Shape& shape);

/// Two-point Gauss rule on [-1, 1] in `dimension` directions.
std::vector<IntegrationPoint> gauss2(int dimension);

/// Multilinear shape functions on [-1, 1]^d with the signs of the corners given.
Shape multilinear(int dimension, const std::vector<Eigen::Vector3d>& corners);

}  // namespace mortise::fem
