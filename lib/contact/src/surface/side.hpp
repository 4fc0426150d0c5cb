// One side of a contact, or the part of it that a rank works on, with its faces in an order that does not depend on the ranks.
#pragma once

#include <array>
#include <compare>
#include <vector>

#include "base/communicator.hpp"
#include "fem/options.hpp"
#include "integrals/overlap.hpp"
#include "mesh/mesh.hpp"
#include "surface/sent_surface.hpp"

namespace mortise::contact {

/// Functions of a face, at most: of its nodes, up to nine, and of corners of what is covered of it.
inline constexpr int most_functions = 12;

/// Shape functions of a face of first or second order, or of its covered part.
using FaceShape = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_functions, 1>;

/// Between two facets: the nodes at its ends, the smaller first; in plane models one node, twice.
using FacetEdge = std::array<Local, 2>;

/// At which a plane or straight lines run into an arc, see find_tangent_edges().
struct TangentEdge {
  /// From the ends of the edge of the face, each with a node beyond it: of the plane, or of the straight line that ends there.
  using Lines = std::array<std::array<Local, 2>, 2>;

  FacetEdge edge;
  bool plane;  ///< else lines
  Lines beyond;

  auto operator<=>(const TangentEdge&) const = default;
};

/// Geometry is done with facets of first order: a face of second order is cut into facets between its nodes, one of first order
/// is its own facet. Displacements and multipliers belong to the faces.
struct Side {
  fem::Kinematics kinematics = fem::Kinematics::solid;
  std::vector<Global> node_id;  ///< ascending
  std::vector<Point> points;
  mesh::Cells faces;                        ///< ordered by face_id
  std::vector<Global> face_id;              ///< of each face
  mesh::Cells facets;                       ///< face by face
  std::vector<Local> face_of;               ///< of each facet
  std::vector<Local> first_facet;           ///< of each face, and the number of all facets
  std::vector<std::array<int, 4>> corners;  ///< of each facet: its nodes' places in the face
  std::vector<bool> affine;                 ///< of each face: facets give the place in it exactly
  std::vector<FacetEdge> kinks;             ///< see find_kinks(), as what follows
  std::vector<TangentEdge> tangent_edges;

  FaceGeometry geometry(std::size_t facet) const;
  bool second_order(std::size_t face) const { return facets_of(face) > 1; }
  std::size_t facets_of(std::size_t face) const { return static_cast<std::size_t>(first_facet[face + 1] - first_facet[face]); }
  /// fem::thickness() where the shape functions of a facet are `shape`.
  double thickness(std::size_t facet, const Eigen::Vector4d& shape) const;
  /// Shape functions of the face of `facet` at the place `at` of an auxiliary plane, where those of the facet are `shape`.
  FaceShape shape_in_face(std::size_t facet, const Eigen::Vector4d& shape, const Frame& frame, const Plane& at) const;
};

/// A side of these nodes, which may come more than once, and faces; `faces` are brought in order. Kinks are not looked for.
Side assemble(std::vector<SentNode> nodes, std::vector<SentFace>& faces, fem::Kinematics kinematics);

/// The whole surface on every rank, without kinks. Collective.
Side gather(const mesh::Surface& surface, fem::Kinematics kinematics, const Communicator& comm);
/// With the body of each face.
std::pair<Side, std::vector<int>> gather_with_bodies(const mesh::Surface& surface, fem::Kinematics kinematics,
                                                     const Communicator& comm);

/// The points of that side alone. Collective.
std::vector<Point> gather_points(const mesh::Surface& surface, const Communicator& comm);
/// The points of a side of these nodes.
std::vector<Point> points_in_order(std::vector<SentNode> nodes);

}  // namespace mortise::contact
