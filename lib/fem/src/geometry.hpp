// One cell in space, shared by stiffness, loads and stresses.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/element.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// Node coordinates of a cell and, at its integration points, gradients and volumes. One object serves a whole loop over cells,
/// in which it stops allocating after the first of each size.
class CellGeometry {
 public:
  explicit CellGeometry(int dimension) : dimension_(dimension) {}

  /// Takes the coordinates of cell c. Its own gradients follow from evaluate().
  void gather(const mesh::Mesh& mesh, std::size_t c)
  {
    element_ = &fem::element(mesh.cells.type[c]);
    const auto nodes = mesh.cells[c];
    x_.resize(nodes.size() * static_cast<std::size_t>(dimension_));
    for (int a = 0; a < dimension_; ++a)
      for (std::size_t i = 0; i < nodes.size(); ++i)
        x_[static_cast<std::size_t>(a) * nodes.size() + i] = mesh.points[static_cast<std::size_t>(nodes[i])][a];
  }

  void evaluate()
  {
    gradients_.resize(element_->points() * x_.size());
    volumes_.resize(element_->points());
    element_->gradients_in_space(*element_, x_.data(), gradients_.data(), volumes_.data());
  }

  const Element& element() const { return *element_; }
  const std::vector<double>& coordinates() const { return x_; }  ///< n x d, column-major
  const std::vector<double>& gradients() const { return gradients_; }
  const std::vector<double>& volumes() const { return volumes_; }

  /// n x d at point q.
  Eigen::Map<const Eigen::MatrixXd> gradient(std::size_t q) const
  {
    return {gradients_.data() + q * x_.size(), element_->nodes, dimension_};
  }

 private:
  int dimension_;
  const Element* element_ = nullptr;
  std::vector<double> x_, gradients_, volumes_;
};

}  // namespace mortise::fem
