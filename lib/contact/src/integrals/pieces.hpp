// Pieces of secondary faces, each with a basis of multipliers of its own.
//
// A face that the primary side covers is one piece. One that crosses the primary side's border is cut into its facets, whose
// bases are linear (bilinear) on them and belong to points inside what is covered: a node that looks past the border is moved to
// the next place that does not. Where too few points are left in this way, as opposite a pad inside a face of second order, the
// face stays one piece with points of its own, see CoveredBasis. A dual basis on a covered part that belonged to the nodes
// themselves would extrapolate: a pressure there would have its resultant, and see its gap, beyond the border [Cichosz and
// Bischoff, CMAME 200 (2011), restore consistency of the basis on such parts; Popp, Seitz, Gee and Wall, CMAME 264 (2013), its
// conditioning].
#pragma once

#include <span>
#include <vector>

#include "surface/side.hpp"

namespace mortise::contact {

/// Of functions or nodes of two faces, without allocation.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_functions, most_functions>;

/// theta = basis * phi: the functions that multipliers of a covered face are dual to, n x n. For a face of first order they are
/// its shape functions. Those of second order have negative parts, and the mean over such a function is no pressure; theta are
/// Bernstein's polynomials in the space of the face (on quad8 what the same combination of its functions gives), which have the
/// sum 1 too: with end points 0, 1 and middle m of an edge theta_0 = phi_0 + phi_m / 4, theta_m = phi_m / 2. What the rows see in
/// place of the middle value u_m is the control value 2 u_m - (u_0 + u_1) / 2 [a transformation as in Popp, Wohlmuth, Gee and
/// Wall, SISC 34 (2012)].
const Eigen::MatrixXd& multiplier_basis(mesh::CellType type);

/// What a row of a face's node sees of the values at all its nodes, n x n: the inverse of multiplier_basis(), transposed.
const Eigen::MatrixXd& control_values(mesh::CellType type);

/// Integrals over a piece with r functions theta of a face with n nodes.
struct PieceIntegrals {
  Local facet = -1;  ///< of the side, whose nodes' functions they are; -1: of all nodes of the face, r = n or, with corners, more
  bool dual = true;  ///< false: too thin for a dual basis; the multipliers are theta themselves
  SmallMatrix mass;  ///< integral theta_i phi_j, r x n
  SmallMatrix gram;  ///< integral theta_i theta_j, r x r
  FaceShape covered;               ///< integral theta_i
  FaceShape whole;                 ///< the same over the piece, covered or not, of functions that belong to its nodes
  FaceShape rise;                  ///< integral theta_i (bulge of both faces)
  std::vector<Local> point_facet;  ///< the facet on which each function's point lies, -1 if there is no such function; r, or
                                   ///< none if functions belong to the nodes
  std::vector<Local> corner;  ///< the primary side's node at each function's point if that is a corner of its own row, or -1;
                              ///< r, or none
  std::vector<Local> beside;  ///< and the node of the face beside it; r, or none
  SmallMatrix points;         ///< its shape functions there, r x 4
  SmallMatrix plane;          ///< where the points lie in the plane of a face that is in one piece, r x 2; else 0 x 2
  std::vector<Local> nodes;   ///< those of the primary side that it meets, in any order
  std::vector<FaceShape> opposite;  ///< for each of them, integral theta_i phi^m
};

/// Moves the points of a facet's functions into what is covered: `common` are the covered parts, convex, in the plane where its
/// nodes lie at `nodes`. On entry the integrals are those of its shape functions, on return those of
/// theta = points^-T shape functions, for which theta_i(point j) = delta_ij. Where the points do not span a basis, or one of
/// them would see next to nothing, the shape functions stay, with the centre of their covered part for a point and no dual basis.
/// Points that are given elsewhere than at the nodes, as their shape functions in the rows of `points`, stay where the nodes are
/// covered.
void move_into(std::span<const Polygon> common, mesh::CellType type, const Few<Plane, 4>& nodes, const SmallMatrix& points,
               PieceIntegrals& piece);

/// The same of a facet that is covered as a whole: theta = points^-T shape functions. False, and the functions stay those of the
/// nodes, where the points span no basis, or a function would see less than a part of what is covered.
bool move_to(const SmallMatrix& points, double least, PieceIntegrals& piece);
/// The part that is nothing but for rounding.
inline constexpr double of_rounding = -1e-12;

/// The integrals of many pieces in one piece of memory, and later, in their place, their shares of the rows.
class PieceStore {
 public:
  using Vector = Eigen::Map<Eigen::VectorXd>;
  using Matrix = Eigen::Map<Eigen::MatrixXd>;
  struct View {
    Local facet;
    bool dual;
    std::span<const Local> point_facet, corner, beside;
    Matrix mass, gram, points, plane;
    Vector covered, whole, rise;
    std::span<const Local> nodes;
    Matrix opposite;  ///< r x nodes
  };

  void add(const PieceIntegrals& piece);
  /// A copy of a piece of another store.
  void add(const View& piece);
  std::size_t size() const { return shapes_.size(); }
  View operator[](std::size_t i);

 private:
  struct Shape {
    Local facet;
    bool dual, own_points, in_plane, corners;
    int r, n;
    std::size_t first_value, first_node;
  };
  std::vector<double> values_;
  std::vector<Local> nodes_;
  std::vector<Shape> shapes_;
};

/// Turns the integrals of a piece into its share of the rows of the nodes that are `kept`; those of the others are 0. Afterwards
/// `mass` has the coefficients of the face's own nodes, `opposite` those of the primary nodes, before they are divided by D;
/// `covered` is D_i and `rise` integral psi_i (bulge of both faces). The dual basis is psi = diag(D) N^-1 theta~. For a dropped
/// node d the others take over: theta~_k = theta_k + sum_d theta_d / (number kept), N_kj = integral theta~_k theta_j, which keeps
/// biorthogonality among those kept and sum psi = 1. In a face with points in its plane they take over in parts for which linear
/// fields stay in the basis, and psi is dual to theta~ itself: resultants stay at the points.
void make_dual(PieceStore::View& piece, std::span<const char> kept);

}  // namespace mortise::contact
