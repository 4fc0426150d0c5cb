// The integrals of one secondary face over its covered part, and its share of the rows.
#pragma once

#include <span>
#include <vector>

#include "places.hpp"
#include "tree.hpp"

namespace mortise::contact {

/// Of two faces' nodes, without allocation.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 9, 9>;

/// theta = basis * phi: the functions that multipliers are dual to, n x n. For a face of first order they are its shape
/// functions. Those of second order have negative parts, and the mean over such a function is no pressure; theta are Bernstein's
/// polynomials in the space of the face (on quad8 what the same combination of its functions gives), which have the sum 1 too:
/// with end points 0, 1 and middle m of an edge theta_0 = phi_0 + phi_m / 4, theta_m = phi_m / 2. What the rows see in place of
/// the middle value u_m is the control value 2 u_m - (u_0 + u_1) / 2 [a transformation as in Popp, Wohlmuth, Gee and Wall, SISC
/// 34 (2012)].
const Eigen::MatrixXd& multiplier_basis(mesh::CellType type);

/// What a row of a face's node sees of the values at all its nodes, n x n: the inverse of multiplier_basis(), transposed.
const Eigen::MatrixXd& control_values(mesh::CellType type);

/// Of a face with n nodes.
struct FaceIntegrals {
  SmallMatrix mass;                 ///< integral theta_i phi_j, n x n
  SmallMatrix gram;                 ///< integral theta_i theta_j
  FaceShape covered;                ///< integral theta_i
  FaceShape whole;                  ///< the same over the whole face
  FaceShape rise;                   ///< integral theta_i (bulge of both faces)
  std::vector<Local> nodes;         ///< those of the primary side that it meets, in any order
  std::vector<FaceShape> opposite;  ///< for each of them, integral theta_i phi^m
};

/// Integrates over secondary faces and what lies opposite them. Holds room to work in.
class Integrator {
 public:
  /// All of which must outlive it. `tree` has the facets of the primary side.
  Integrator(const Side& secondary, const Places& secondary_places, const Side& primary, const Places& primary_places,
             const Tree& tree, double reach);
  /// Everything on the primary side that a face looks at within reach. Valid until the next call.
  const FaceIntegrals& integrate(std::size_t face);
  /// The same where a rigid obstacle lies opposite all of the face, which has no nodes.
  const FaceIntegrals& integrate_whole(std::size_t face);

 private:
  void reset(std::size_t face);
  void add_whole(std::size_t facet);
  template <class Add>
  void over_facet(std::size_t facet, const Add& add);
  void add_pair(std::size_t facet, std::size_t other, const Bulge& own_bulge);
  template <class Vector, class Matrix>
  void add_points(std::size_t facet, std::size_t other, const Bulge& own_bulge, Vector zero, Matrix square, Matrix across);

  const Side& secondary_;
  const Places& secondary_places_;
  const Side& primary_;
  const Places& primary_places_;
  const Tree& tree_;
  double reach_;
  FaceIntegrals result_;
  std::vector<Local> slot_;  // of each primary node its place in result_.nodes, or -1
  Overlap overlap_;
  std::vector<int> met_;
};

/// The integrals of many faces in one piece of memory, and later, in their place, the faces' shares of the rows.
class FaceStore {
 public:
  using Vector = Eigen::Map<Eigen::VectorXd>;
  using Matrix = Eigen::Map<Eigen::MatrixXd>;
  struct View {
    Matrix mass, gram;
    Vector covered, whole, rise;
    std::span<const Local> nodes;
    Matrix opposite;  ///< n x nodes
  };

  void add(const FaceIntegrals& face);
  std::size_t size() const { return first_value_.size(); }
  View operator[](std::size_t i);

 private:
  std::vector<double> values_;
  std::vector<Local> nodes_;
  std::vector<std::size_t> first_value_, first_node_;
  std::vector<int> n_;
};

/// Turns the integrals of a face into its share of the rows of the nodes that are `kept`; those of the others are 0. Afterwards
/// `mass` has the coefficients of its own nodes, `opposite` those of the primary nodes, before they are divided by D; `covered`
/// is D_i and `rise` integral psi_i (bulge of both faces). The dual basis is psi = diag(D) N^-1 theta~. For a dropped node d the
/// others take over: theta~_k = theta_k + sum_d theta_d / (number kept), N_kj = integral theta~_k theta_j, which keeps
/// biorthogonality among those kept and sum psi = 1.
void make_dual(FaceStore::View& face, std::span<const char> kept);

/// One coefficient of the rows before they are divided by D: secondary or primary node, value.
struct Term {
  Local node;
  bool on_primary;
  double value;
};

}  // namespace mortise::contact
