// The linear law of a material in the axes of the model: strains and stresses in the order XX YY ZZ XY YZ XZ, shear strains as
// the change of the angle.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fem/stiffness.hpp"
#include "fem/stress.hpp"
#include "geometry.hpp"

namespace mortise::fem {

class Elasticity {
 public:
  using Matrix = Eigen::Matrix<double, 6, 6>;

  Elasticity(const Material& material, Kinematics kinematics);

  bool orthotropic() const { return material_.orthotropic.has_value(); }
  /// Of an isotropic one.
  const Lame& lame() const { return lame_; }
  /// Whether it is the same everywhere.
  bool uniform() const { return !material_.directions || !material_.directions->cylindrical(); }

  /// C of stress = C strain at a place. In plane stress without ZZ, which is condensed; in axisymmetry ZZ is the hoop.
  Matrix stiffness(const Point& x) const;
  /// The strain that a degree makes where nothing hinders it.
  Stress expansion(const Point& x) const;
  /// s : C^-1 : s. It serves the plane states as well, because the stress across the plane is among the six.
  double complementary(const Stress& s, const Point& x) const;
  /// From the displacement gradient H = du_i / dx_j and the degrees that the place is warmer.
  Stress stress(const Eigen::Matrix3d& h, double warmer, const Point& x) const;

 private:
  // Rows: the directions 1, 2, 3 of the material.
  Eigen::Matrix3d axes(const Point& x) const;

  Material material_;
  Kinematics kinematics_;
  Lame lame_{};
  Matrix local_ = Matrix::Zero();     // C along the directions of an orthotropic material
  Eigen::Matrix3d flexibility_ = {};  // of its normal strains
  std::optional<Matrix> everywhere_;  // C if it is uniform
};

/// The symmetric part of a gradient in that order.
Stress strain_of(const Eigen::Matrix3d& h);
/// B of strain = B u for the rows of `gradients` (m x d), one a node or a mode, unknown d * row + component: 6 x (d m). In
/// axisymmetry `hoop` has the nodes' hoop strains.
Eigen::Matrix<double, 6, Eigen::Dynamic> strain_matrix(const Eigen::Ref<const Eigen::MatrixXd>& gradients,
                                                       const double* hoop = nullptr);
/// Where integration point q of a cell is.
Point place_of(const CellGeometry& cell, std::size_t q);

}  // namespace mortise::fem
