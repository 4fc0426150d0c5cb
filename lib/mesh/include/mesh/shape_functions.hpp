// The shape functions of cells, at any place of the reference cell: quadrilaterals and hexahedra in [-1, 1]^d, triangles and
// tetrahedra in the unit simplex, prisms in the unit triangle times [-1, 1].
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::mesh {

/// Each function is a polynomial of the cell's space that is 1 at its node and 0 at the others.
class ShapeFunctions {
 public:
  explicit ShapeFunctions(CellType type);

  /// n, one for each node.
  int count() const { return static_cast<int>(coefficients_.rows()); }
  const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }  ///< reference coordinates
  /// `value`, n entries, and `gradient`, n x dimension, at a point; the latter may be null.
  void evaluate(const Eigen::Vector3d& at, Eigen::Ref<Eigen::VectorXd> value, Eigen::MatrixXd* gradient = nullptr) const;

 private:
  int dimension_;
  std::vector<std::array<int, 3>> exponents_;
  std::vector<Eigen::Vector3d> nodes_;
  Eigen::MatrixXd coefficients_;  // functions x monomials
};

/// Made once for each type, and shared.
const ShapeFunctions& shape_functions(CellType type);

}  // namespace mortise::mesh
