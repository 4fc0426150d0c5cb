// Reference elements: shape functions tabulated at integration points. To add one: a file in src/elements, its declaration there and a
// row in element.cpp.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "mesh/cell.hpp"

namespace mortise::fem {

/// Tables over the q integration points of a cell or face with n nodes in its own d coordinates.
struct Element {
  int dimension = 0;
  int nodes = 0;
  std::vector<double> weight;              ///< q
  std::vector<Eigen::VectorXd> shape;      ///< q times n
  std::vector<Eigen::MatrixXd> gradient;   ///< q times n x d, by the reference coordinates
  Eigen::MatrixXd extrapolation;           ///< n x q: from integration points to nodes, by least squares in the shape functions
};

const Element& element(mesh::CellType type);

}  // namespace mortise::fem
