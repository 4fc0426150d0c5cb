// Stresses from displacements, and what they say of the mesh's error.
//
// Stresses sigma_a that are shown are averaged at the nodes of each body, material by material. The error of the finite element
// stresses sigma_h in the energy norm is estimated from a second recovery, sigma_p by polynomials on patches of cells
// [fem/patches.hpp; Zienkiewicz and Zhu, Int. J. Numer. Methods Eng. 33 (1992)]:
//
//   error^2 = || sigma_p - sigma_h ||^2 + || sigma_p - sigma_a ||^2.
//
// Where stresses are smooth both recoveries are an order more exact than sigma_h and the second term is next to nothing; near
// clamped edges, corners and edges of punches neither is, and what they differ by says how far sigma_p itself may be off.
//
// At nodes on planes of symmetry both are those of the whole body: cells beyond the plane have the mirror images of the stresses,
// so that the shear across it cancels in averages (fem/symmetry.hpp), and patches go on in them (of planes at right angles).
//
// At nodes of a sector's cuts that match, both are means with those of the node that is one with it, rotated.
//
// At faces that nothing acts along neither recovery of the estimate has shear (SymmetricNodes::shear_free), as the exact stress
// has none: where stresses are smooth along a body of one or two cells across, nothing else shows the error [cf. Rodenas et al.,
// Int. J. Numer. Methods Eng. 70 (2007), who make recovered stresses fulfil the boundary's equilibrium]. So it is with the
// tractions across faces, in one layer of cells of first order: through the wall of a tube the radial stress goes from what
// presses to nothing, where cells know its mean.
//
// Of boundary elements stresses are known at the surface, panel by panel, and averaged in the same way.
#pragma once

#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "bem/stress_recovery.hpp"
#include "fem/constitution.hpp"
#include "fem/held_faces.hpp"
#include "feti/subdomain_operator.hpp"
#include "partition/congruence.hpp"
#include "partition/node_directory.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// A node on planes that bear no traction along themselves, as planes of symmetry: their unit normals, out of the body. Between
/// two of them the body has a right angle or less.
struct SymmetricNode {
  Local node;
  std::vector<Point> normals;
  std::vector<double> tractions = {};  ///< along each normal; not a number where it is not known, none if no one asks
};

/// A node on the cut of a sector that is one with a node of its other cut, rotated: u(node) = rotation u(other).
struct RotatedNode {
  Local node;
  Global subdomain;  ///< of one copy of the other node
  Local other;
  Eigen::Matrix3d rotation;
};

/// Nodes at which a body goes on beyond what is meshed of it: of each subdomain of this rank, ascending; all copies of a node
/// have the same.
struct SymmetricNodes {
  std::vector<std::vector<SymmetricNode>> mirrored;  ///< in planes; no subdomain if there are none on any rank
  std::vector<std::vector<RotatedNode>> rotated;     ///< in sectors; no subdomain if there are none on any rank
  /// Not symmetric, but faces there bear no traction along themselves: recovered stresses of the error estimate have none either,
  /// and across one layer of cells of first order the tractions that loads give.
  std::vector<std::vector<SymmetricNode>> shear_free = {};
  std::vector<std::vector<fem::HeldFace>> held_faces = {};  ///< of each subdomain of this rank, by cells
};

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
  const SymmetricNodes* symmetric = nullptr;  ///< null, on all ranks: the body ends where its mesh does
};

/// What the inside of a subdomain of boundary elements follows from, less the particular solution: displacements (D n) and
/// tractions (D m) of its surface, in space the stresses recovered round its nodes as well.
struct SurfaceField {
  Eigen::VectorXd displacement, traction;
  std::vector<bem::LinearStress> recovered;
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
  std::vector<double> body_energy;    ///< and of the strain energy
};

/// The stresses of displacements of each subdomain. `loose`: nodes of contacts with friction that slip or are open, ascending; of
/// each node some rank that has a copy knows it. Collective.
StressField recover_stress(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                           const Communicator& comm, std::span<const Global> loose = {});

/// In the energy norm: an error of the mesh for the solver to stop by, and the size of the solution. It is || sigma_a - sigma_h
/// ||, which costs least and is rather less than the error that is claimed. That of boundary elements is taken for a hundredth of
/// their part of the solution.
struct EnergyNorms {
  double error = 0, solution = 0;
};
/// Of displacements of each subdomain. The error of boundary elements is taken for a hundredth of their part of the solution,
/// since the estimate of recover_stress() needs tractions, which cost much. Collective.
EnergyNorms energy_norms(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

}  // namespace mortise::post
