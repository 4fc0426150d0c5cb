// One side of a contact, whole on every rank, with its faces in an order that does not depend on the ranks. Surfaces are small
// beside the bodies; the work on them is shared out face by face.
#pragma once

#include <array>
#include <vector>

#include "base/communicator.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"
#include "overlap.hpp"

namespace mortise::contact {

/// Shape functions of a face of first or second order.
using FaceShape = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 9, 1>;

/// Geometry is done with facets of first order: a face of second order is cut into facets between its nodes, one of first order
/// is its own facet. Displacements and multipliers belong to the faces.
struct Side {
  fem::Kinematics kinematics = fem::Kinematics::solid;
  std::vector<Global> node_id;  ///< ascending
  std::vector<Point> points;
  mesh::Cells faces;                        ///< ordered by face_id
  mesh::Cells facets;                       ///< face by face
  std::vector<Local> face_of;               ///< of each facet
  std::vector<Local> first_facet;           ///< of each face, and the number of all facets
  std::vector<std::array<int, 4>> corners;  ///< of each facet: its nodes' places in the face
  std::vector<bool> affine;                 ///< of each face: facets give the place in it exactly

  FaceGeometry geometry(std::size_t facet) const;
  bool second_order(std::size_t face) const { return facets_of(face) > 1; }
  std::size_t facets_of(std::size_t face) const { return static_cast<std::size_t>(first_facet[face + 1] - first_facet[face]); }
  /// fem::thickness() where the shape functions of a facet are `shape`.
  double thickness(std::size_t facet, const Eigen::Vector4d& shape) const;
  /// Shape functions of the face of `facet` at the place `at` of an auxiliary plane, where those of the facet are `shape`.
  FaceShape shape_in_face(std::size_t facet, const Eigen::Vector4d& shape, const Frame& frame, const Plane& at) const;
};

/// Collective.
Side gather(const mesh::Surface& surface, fem::Kinematics kinematics, const Communicator& comm);

/// A place that may carry a multiplier: a node and the faces on one side of a kink there.
struct Place {
  Local node;
  Point normal;  ///< unit; exact where the faces inscribe a sphere or cylinder [weights of Max, J. Graph. Tools 4 (1999)]
};

/// The places of a side, and the place that each corner of a facet (at facets.offset[f] + corner) and each node of a face (at
/// faces.offset[f] + node) belongs to. Facets round a node belong together if a chain of them turns by less than about 40 degrees
/// from one to the next.
struct Places {
  std::vector<Place> all;
  std::vector<Local> of_corner, of_node;
};
///
/// At the border of a surface, where faces lie on one side only, normals continue the curvature of the edges that lead inside: an
/// arc has opposite slopes at its ends.
Places find_places(const Side& side);

/// How far the smooth surface through the nodes stands out of a face (positive outwards) at reference shape values `shape`: the
/// quadratic that bulges by (x_j - x_i).(n_j - n_i) / 8 at the middle of edge ij. It makes the gaps between facetted cylinders
/// and spheres exact to fourth order in the size of the facets, while the facets alone are wrong by their sagitta.
class Bulge {
 public:
  Bulge(const FaceGeometry& face, std::span<const Point> normals);
  double operator()(const Eigen::Vector4d& shape) const;

 private:
  std::size_t n_;
  std::array<double, 4> rise_{};  // at the middle of each edge
};

}  // namespace mortise::contact
