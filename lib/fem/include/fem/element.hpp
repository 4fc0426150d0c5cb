// Reference elements: shape functions tabulated at integration points, and the two kernels in which a program that assembles
// stiffnesses spends its time, compiled for the size of each element. To add one: its rule in rules.cpp and a row
// in element.cpp.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/options.hpp"
#include "mesh/cell.hpp"

namespace mortise::fem {

/// Tables over the q integration points of a cell or face with n nodes in its own d coordinates.
struct Element {
  int dimension = 0;
  int nodes = 0;
  std::vector<double> weight;             ///< q
  std::vector<Eigen::Vector3d> point;     ///< q, in reference coordinates
  std::vector<Eigen::VectorXd> shape;     ///< q times n
  std::vector<Eigen::MatrixXd> gradient;  ///< q times n x d, by the reference coordinates
  Eigen::MatrixXd extrapolation;  ///< n x q: from integration points to nodes, by least squares in first-order shape functions

  /// Gradients by the space coordinates, q times n x d, and the volumes that the points stand for, of the cell with the nodes at
  /// x, n x d. All matrices column-major. A volume that is not positive means that the cell is inside out there; its gradients
  /// are then useless.
  void (*gradients_in_space)(const Element& element, const double* x, double* gradients, double* volumes) = nullptr;

  /// K of one cell, (d n) x (d n), unknown d * node + component, from the results of gradients_in_space(): block ij is the sum
  /// over the points of volume * (lambda g_i g_j' + mu g_j g_i' + mu (g_i . g_j) I).
  void (*stiffness)(const Element& element, const double* gradients, const double* volumes, double lambda, double mu,
                    double* k) = nullptr;

  Eigen::MatrixXd centre_gradient;  ///< n x d, at the origin of the reference cell, by the reference coordinates
  /// As `stiffness`, for gradients of n nodes and d modes, (n + d) x d. Null for cells without incompatible modes.
  void (*stiffness_with_modes)(const Element& element, const double* gradients, const double* volumes, double lambda, double mu,
                               double* k) = nullptr;

  std::size_t points() const { return weight.size(); }
};

/// The tables of a type of cell or face, made once and shared. In axisymmetry tri3 has three points: with the one that a constant
/// strain needs, a displacement u_r / r that vanishes there would have no energy.
const Element& element(mesh::CellType type, Kinematics kinematics = Kinematics::solid);

}  // namespace mortise::fem
