// Stresses of subdomains of boundary elements: at their surfaces, from displacements and the tractions that belong to them.
#pragma once

#include "bem/particular_solution.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::post {

/// As fem::StressField, of one subdomain: its cells are panels.
struct BoundaryStress {
  Eigen::MatrixXd nodal_sums;            ///< nodes x 7 blocks, weighted with the panels' areas
  Eigen::MatrixXd stress;                ///< panels x 6
  Eigen::MatrixXd traction;              ///< panels x 3
  Eigen::VectorXd interpolation_errors;  ///< of panels of plane models, see bem/surface_stress.hpp; else empty
  Eigen::VectorXd traction_errors;       ///< of the same, squared: how far tractions are from those of the fit at the nodes
  SurfaceField surface;
};

/// Of weight and temperature of a subdomain of boundary elements.
bem::ParticularSolution particular_solution(const ElasticBodies& bodies, std::size_t subdomain);

/// Of every subdomain of this rank; empty where it is made of finite elements. Copies are solved together. Collective.
std::vector<BoundaryStress> boundary_stresses(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                              const Communicator& comm);

/// Energy of the elastic strain of a subdomain of boundary elements.
double boundary_energy(const ElasticBodies& bodies, std::size_t subdomain, const Eigen::VectorXd& displacement);

/// For each panel an estimate of its part of the squared error in the energy norm: h area (a (s* - s) C^-1 (s* - s) / 2 +
/// b |s* n - t|^2 / (2 mu)), where s* is the recovered stress, nodes x 6, s and t are those of the panel, and h is its size:
/// tractions alone do not see bending that linear displacements cannot follow. In plane models h area |s* n - t|^2 / (2 mu), s*
/// the recovered stress or the fit at the nodes (bem/stress_recovery.hpp), whichever is farther off, and the interpolation error.
Eigen::VectorXd boundary_errors(const ElasticBodies& bodies, std::size_t subdomain, const BoundaryStress& found,
                                const Eigen::MatrixXd& recovered);

}  // namespace mortise::post
