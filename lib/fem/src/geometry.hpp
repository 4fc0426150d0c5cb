// One cell in space, shared by stiffness, loads and stresses.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "fem/element.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// Node coordinates of a cell and, at its integration points, gradients and volumes. One object serves a whole loop over cells,
/// in which it stops allocating after the first of each size.
class CellGeometry {
 public:
  explicit CellGeometry(Kinematics kinematics)
      : dimension_(dimension(kinematics)), axisymmetric_(kinematics == Kinematics::axisymmetric)
  {
  }

  /// Takes the coordinates of cell c. Its own gradients follow from evaluate(). Throws Error(bad_input) for a cell of another
  /// dimension than the model's: a panel of boundary elements.
  void gather(const mesh::Mesh& mesh, std::size_t c)
  {
    if (mesh::dimension(mesh.cells.type[c]) != dimension_)
      throw Error(ExitStatus::bad_input, "a cell of type " + std::string(mesh::name(mesh.cells.type[c])) +
                                             " is no finite element of a model of dimension " + std::to_string(dimension_));
    element_ = &fem::element(mesh.cells.type[c], axisymmetric_ ? Kinematics::axisymmetric : Kinematics::solid);
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
    if (axisymmetric_) revolve();
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

  bool axisymmetric() const { return axisymmetric_; }
  /// N_i / r at point q: the hoop strain of a unit radial displacement of node i.
  Eigen::Map<const Eigen::VectorXd> hoop(std::size_t q) const
  {
    return {hoop_.data() + q * static_cast<std::size_t>(element_->nodes), element_->nodes};
  }

 private:
  // Volumes and hoop strains of the whole turn.
  void revolve()
  {
    const auto n = static_cast<std::size_t>(element_->nodes);
    hoop_.resize(element_->points() * n);
    const Eigen::Map<const Eigen::VectorXd> r(x_.data(), element_->nodes);
    for (std::size_t q = 0; q < element_->points(); ++q) {
      const double radius = element_->shape[q].dot(r);
      volumes_[q] *= thickness(Kinematics::axisymmetric, radius);
      Eigen::Map<Eigen::VectorXd>(hoop_.data() + q * n, element_->nodes) = element_->shape[q] / radius;
    }
  }

  int dimension_;
  bool axisymmetric_;
  const Element* element_ = nullptr;
  std::vector<double> x_, gradients_, volumes_, hoop_;
};

}  // namespace mortise::fem
