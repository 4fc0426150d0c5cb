// One side of a contact, whole on every rank, with its faces in an order that does not depend on the ranks. Surfaces are small
// beside the bodies; the work on them is shared out face by face.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"
#include "overlap.hpp"

namespace mortise::contact {

struct Side {
  std::vector<Global> node_id;  ///< ascending
  std::vector<Point> points;
  mesh::Cells faces;  ///< ordered by face_id
  FaceGeometry geometry(std::size_t face) const;
};

/// Collective.
Side gather(const mesh::Surface& surface, const Communicator& comm);

/// A place that may carry a multiplier: a node and the faces on one side of a kink there.
struct Place {
  Local node;
  Point normal;  ///< unit; exact where the faces inscribe a sphere or cylinder [weights of Max, J. Graph. Tools 4 (1999)]
};

/// The places of a side and the place that each face corner belongs to (at faces.offset[f] + corner). Faces round a node belong
/// together if a chain of them turns by less than about 40 degrees from one to the next.
struct Places {
  std::vector<Place> all;
  std::vector<Local> of_corner;
};
///
/// At the border of a surface, where faces lie on one side only, normals continue the curvature of the edges that lead inside: an
/// arc has opposite slopes at its ends.
Places find_places(const Side& side);

/// How far the smooth surface through the nodes stands out of a face (positive outwards) at reference shape values `shape`: the
/// quadratic that bulges by (x_j - x_i).(n_j - n_i) / 8 at the middle of edge ij. It makes the gaps between facetted cylinders
/// and spheres exact to fourth order in the size of the facets, while the facets alone are wrong by their sagitta.
double bulge(const FaceGeometry& face, std::span<const Point> normals, const Eigen::Vector4d& shape);

}  // namespace mortise::contact
