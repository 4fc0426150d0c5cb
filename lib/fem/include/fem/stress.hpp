// Stresses at integration points, their recovery at nodes, and what the two say about the error of the mesh.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/materials.hpp"
#include "fem/temperature.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// XX YY ZZ XY YZ XZ.
using Stress = Eigen::Matrix<double, 6, 1>;

/// sqrt(3/2 s:s) of the deviator s, in the unit of the stress.
double von_mises(const Stress& stress);

/// What one piece knows of the stress.
struct StressField {
  /// nodes x 7 blocks: sums over the cells of the piece of volume * stress extrapolated to the node, and of the volumes; in block
  /// k, columns 7 k .. 7 k + 6, over cells of the k-th material. Added up over the copies of a node and divided by the last
  /// column of its block this is the recovered nodal stress, which never mixes two bodies or two materials: stresses jump between
  /// them.
  Eigen::MatrixXd nodal_sums;
  /// Of each cell, from the volume mean of its stress.
  Eigen::VectorXd cell_von_mises;
  /// Integral of s : C^-1 : s / 2, the energy of the elastic strain: 1/2 u'K u where nothing expands freely.
  double strain_energy = 0;
};
/// At the integration points of all cells, one after the other: the stress, and the volume that each stands for.
struct PointStresses {
  std::vector<Stress> stress;
  std::vector<double> volume;
};
/// `temperature_change` expands the piece, which has no stress by that alone (see add_expansion). `blocks`: at least the number
/// of materials. `points`: if not null, gets what squared_errors() would else evaluate again.
StressField stresses(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const Eigen::VectorXd& u,
                     Formulation formulation = Formulation::standard, const Temperature& temperature_change = {},
                     std::size_t blocks = 1, PointStresses* points = nullptr);

/// For each cell the squared energy norm of s* - s: the integral of (s* - s) : C^-1 : (s* - s), where s is the stress of the
/// finite elements and s* interpolates `recovered`, nodes x 6 blocks (of the cell's material), by the shape functions
/// [Zienkiewicz and Zhu, A simple error estimator and adaptive procedure for practical engineering analysis, IJNME 24 (1987)].
/// The sum over all cells estimates ||u - u_h||^2 in the energy norm; in the same norm ||u_h||^2 is twice the strain energy.
/// `temperature_change` as in stresses().
Eigen::VectorXd squared_errors(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                               const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered,
                               Formulation formulation = Formulation::standard, const Temperature& temperature_change = {});

/// The sum of these over all cells, from their stresses.
double squared_error(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const PointStresses& points,
                     const Eigen::MatrixXd& recovered);

/// The same, and for each cell the squared norm of the difference of `recovered` and `other`, two recoveries of the same stress,
/// which says how well either knows it: where s is smooth they agree, at a corner with steep stresses neither is right.
Eigen::VectorXd squared_errors(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                               const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered, const Eigen::MatrixXd& other,
                               Formulation formulation = Formulation::standard, const Temperature& temperature_change = {});

/// For each cell (hex8, quad4; none of others) the squared energy norm of what incompatible modes would add
/// to the displacements u of standard cells: that of s - s*, of twice the energy that they would take away. In one layer of
/// cells, which are too stiff in bending, it is most of the error, and recovered stresses do not show it.
Eigen::VectorXd squared_errors_of_bending(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                          const Eigen::VectorXd& u, const Temperature& temperature_change = {});

/// For each cell how many times larger the error of nearly incompressible material is than recovered stresses say: cells of
/// second order of standard formulation, but tri6, are too stiff then, and what they lack is smooth. 1 up to a bulk modulus of
/// ten times that of shear (Poisson's ratio 0.45), 1.35 at 0.49, 1.85 at 0.499, at most 2.2: bonded pads and bushes in shear, of
/// quad8, quad9, hex20, hex27 and tet10, claim 0.8 to 1.4 times their true error so. 1 of all other cells.
Eigen::VectorXd unseen_by_locking(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                  Formulation formulation);

/// For each cell the squared energy norm of the expansion that its formulation does not take, what a temperature that varies in
/// it differs from its mean by; see add_expansion(). A layer of cells that would bend by it stays straight, and has no stress
/// that shows it.
Eigen::VectorXd squared_errors_of_temperature(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                              Formulation formulation, const Temperature& temperature_change);

}  // namespace mortise::fem
