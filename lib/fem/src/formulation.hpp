// What a formulation makes of one cell: its stiffness, and its displacement gradients from nodal displacements.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "elasticity.hpp"
#include "fem/stiffness.hpp"
#include "geometry.hpp"

namespace mortise::fem {

/// standard: full integration.
/// bbar: the change of volume is that of the whole cell, div u -> mean of div u [Hughes, IJNME 15 (1980)].
/// incompatible: u gains a_k (1 - xi_k^2) for each direction k of the reference cell, eliminated cell by cell; their gradients
/// are taken with the Jacobian of the centre, which keeps the patch test [Wilson et al. (1973); Taylor, Beresford and Wilson,
/// IJNME 10 (1976)]. In axisymmetry these have no hoop strain of their own: good enough to tell what bends, not for K.
/// Orthotropic materials have the first and the last.
class CellFormulation {
 public:
  CellFormulation(Formulation formulation, const Elasticity& elasticity, Kinematics kinematics)
      : formulation_(formulation), elasticity_(elasticity), dimension_(dimension(kinematics))
  {
  }

  /// K of the cell, (d n) x (d n), column-major, unknown d * node + component.
  void stiffness(const CellGeometry& cell, std::vector<double>& k);
  /// du_i/dx_j at each integration point from nodal displacements, d x n; their symmetric parts are the strains. Across a plane
  /// bbar gives a strain that only its volume knows; in axisymmetry u_r / r stands there. `warmer`: degrees at each point, which
  /// push incompatible modes.
  const std::vector<Eigen::Matrix3d>& gradients(const CellGeometry& cell, const Eigen::MatrixXd& displacement,
                                                std::span<const double> warmer);
  /// What nodes feel of the modes' expansion by these degrees, to be taken from their own: K_nm K_mm^-1 f_m, d n.
  Eigen::VectorXd forces_of_modes(const CellGeometry& cell, std::span<const double> warmer);

 private:
  Eigen::MatrixXd enriched_stiffness(const CellGeometry& cell);
  Eigen::VectorXd expansion_of_modes(const CellGeometry& cell, std::span<const double> warmer) const;
  void add_hoop_forces(const CellGeometry& cell, Eigen::VectorXd& forces) const;

  Formulation formulation_;
  Elasticity elasticity_;
  int dimension_;
  std::vector<double> enriched_;  // gradients, (n + d) x d a point
  std::vector<Eigen::Matrix3d> result_;
};

}  // namespace mortise::fem
