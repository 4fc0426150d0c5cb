// The integrals of one secondary face over its covered part, and its share of the rows.
#pragma once

#include <vector>

#include "side.hpp"
#include "tree.hpp"

namespace mortise::contact {

/// theta = basis * phi: the functions that multipliers are dual to, n x n. For a face of first order they are its shape
/// functions. Those of second order have negative parts, and the mean over such a function is no pressure; theta are Bernstein's
/// polynomials in the space of the face (on quad8 what the same combination of its functions gives), which have the sum 1 too:
/// with end points 0, 1 and middle m of an edge theta_0 = phi_0 + phi_m / 4, theta_m = phi_m / 2. What the rows see in place of
/// the middle value u_m is the control value 2 u_m - (u_0 + u_1) / 2 [a transformation as in Popp, Wohlmuth, Gee and Wall, SISC
/// 34 (2012)].
Eigen::MatrixXd multiplier_basis(mesh::CellType type);

/// Of a face with n nodes.
struct FaceIntegrals {
  Eigen::MatrixXd mass;     ///< integral theta_i phi_j, n x n
  Eigen::MatrixXd gram;     ///< integral theta_i theta_j
  Eigen::VectorXd covered;  ///< integral theta_i
  Eigen::VectorXd whole;    ///< the same over the whole face
  Eigen::VectorXd rise;     ///< integral theta_i (bulge of both faces)
  std::vector<std::pair<Local, Eigen::VectorXd>>
      opposite;  ///< for each primary node met, integral theta_i phi^m, ascending nodes
};

/// Everything on the primary side that face `face` looks at within `reach`.
FaceIntegrals integrate(const Side& secondary, const Places& secondary_places, std::size_t face, const Side& primary,
                        const Places& primary_places, const Tree& tree, double reach);

/// The same where a rigid obstacle lies opposite all of the face, which has no nodes.
FaceIntegrals integrate_whole(const Side& secondary, std::size_t face);

/// The normals of the places at the corners of a facet.
std::vector<Point> corner_normals(const Side& side, const Places& places, std::size_t facet);

/// One coefficient of the rows before they are divided by D: place, secondary or primary node, value.
struct Term {
  Local place;
  Local node;
  bool on_primary;
  double value;
};

/// The dual basis psi of the face for the nodes that are `kept`, applied to the integrals: terms of D and -M, and D_i of each
/// kept node (0 for the others). For a dropped node d the others take over: psi = diag(D) N^-1 theta~ with theta~_k = theta_k +
/// sum_d theta_d / (number kept), N_kj = integral theta~_k theta_j, which keeps biorthogonality among those kept and sum psi = 1.
struct FaceRows {
  Eigen::VectorXd d;
  Eigen::VectorXd rise;  ///< integral psi_i (bulge of both faces)
  std::vector<Term> terms;
};
FaceRows dual_rows(const FaceIntegrals& integrals, const std::vector<bool>& kept, std::span<const Local> nodes,
                   std::span<const Local> places);

}  // namespace mortise::contact
