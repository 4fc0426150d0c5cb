// Stresses from displacements, and what they say of the mesh's error.
//
// Recovered stresses sigma* are averaged at the nodes of each body, material by material; the error of the finite element
// stresses sigma_h in the energy norm is estimated by || sigma* - sigma_h || [Zienkiewicz and Zhu, Int. J. Numer. Methods Eng. 24
// (1987)].
//
// Of boundary elements stresses are known at the surface, panel by panel, and averaged in the same way.
#pragma once

#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "fem/constitution.hpp"
#include "feti/subdomain_operator.hpp"
#include "partition/congruence.hpp"
#include "partition/node_directory.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// What the recovery works on. Refers to its parts.
struct ElasticBodies {
  const partition::Decomposition& decomposition;
  const partition::Interface& interface;
  fem::Kinematics kinematics;
  std::span<const fem::Constitution> constitution;  ///< of each subdomain of this rank
  std::size_t blocks = 1;                           ///< the most materials of any body
  /// What subdomains of boundary elements need as well: what each is a copy of, and the operators.
  std::span<const partition::CopyOf> copies = {};
  std::span<const std::shared_ptr<const feti::SubdomainOperator>> operators = {};
};

/// What the inside of a subdomain of boundary elements follows from: displacements (3 n) and tractions (3 m) of its surface, less
/// those of its particular solution.
struct SurfaceField {
  Eigen::VectorXd displacement, traction;
};

/// Fields of each subdomain of this rank, in the deck's unit of stress, and sums over all ranks.
struct StressField {
  std::vector<Eigen::MatrixXd> nodal;  ///< nodes x 6, recovered inside the body
  /// Where bodies have several materials: nodes x 6 blocks, the stress in each material; at nodes between two of them `nodal` is
  /// that with the larger von Mises stress. And the block of each cell. Else empty.
  std::vector<Eigen::MatrixXd> by_material;
  std::vector<std::vector<int>> cell_block;
  std::vector<Eigen::VectorXd> nodal_von_mises, cell_von_mises;
  std::vector<SurfaceField> surface;  ///< of boundary elements; else empty
  Found largest_von_mises;            ///< of all nodes
  double strain_energy = 0;           ///< of the elastic strain
  double squared_error = 0;           ///< estimated, in the energy norm
  std::vector<Found> worst_cell;      ///< of each body: the largest squared error of a cell of this rank, at the cell's centre
  std::vector<double> body_error;     ///< of each body: its part of the squared error on this rank
};

/// The stresses of displacements of each subdomain. Collective.
StressField recover_stress(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                           const Communicator& comm);

/// In the energy norm: the estimated error of the mesh, and the size of the solution.
struct EnergyNorms {
  double error = 0, solution = 0;
};
/// Of displacements of each subdomain. The error of boundary elements is taken for a hundredth of their part of the solution,
/// since the estimate of recover_stress() needs tractions, which cost much. Collective.
EnergyNorms energy_norms(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

}  // namespace mortise::post
