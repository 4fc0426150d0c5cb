// The integrals of one secondary face over its covered part, and its share of the rows.
#pragma once

#include <vector>

#include "side.hpp"
#include "tree.hpp"

namespace mortise::contact {

/// Of a face with n nodes.
struct FaceIntegrals {
  Eigen::MatrixXd mass;                                     ///< integral phi_i phi_j, n x n
  Eigen::VectorXd covered;                                  ///< integral phi_i
  Eigen::VectorXd whole;                                    ///< the same over the whole face
  Eigen::VectorXd rise;                                     ///< integral phi_i (bulge of both faces)
  std::vector<std::pair<Local, Eigen::VectorXd>> opposite;  ///< for each primary node met, integral phi_i phi^m, ascending nodes
};

/// Everything on the primary side that face `face` looks at within `reach`.
FaceIntegrals integrate(const Side& secondary, const Places& secondary_places, std::size_t face, const Side& primary,
                        const Places& primary_places, const Tree& tree, double reach);

/// The normals of the places at the corners of a face.
std::vector<Point> corner_normals(const Side& side, const Places& places, std::size_t face);

/// One coefficient of the rows before they are divided by D: place, secondary or primary node, value.
struct Term {
  Local place;
  Local node;
  bool on_primary;
  double value;
};

/// The dual basis psi of the face for the corners that are `kept`, applied to the integrals: terms of D and -M, and D_i of each
/// kept corner (0 for the others). For a dropped corner d the others take over: psi = diag(D) N^-1 phi~ with phi~_k = phi_k +
/// sum_d phi_d / (number kept), N_kj = integral phi~_k phi_j, which keeps biorthogonality among those kept and sum psi = 1.
struct FaceRows {
  Eigen::VectorXd d;
  Eigen::VectorXd rise;  ///< integral psi_i (bulge of both faces)
  std::vector<Term> terms;
};
FaceRows dual_rows(const FaceIntegrals& integrals, const std::vector<bool>& kept, std::span<const Local> nodes,
                   std::span<const Local> places);

}  // namespace mortise::contact
