// One side of a contact, whole on every rank, with its faces in an order that does not depend on the ranks. Surfaces are small beside
// the bodies; the work on them is shared out face by face.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"
#include "overlap.hpp"

namespace mortise::contact {

struct Side {
  std::vector<Global> node_id;   ///< ascending
  std::vector<Point> points;
  mesh::Cells faces;             ///< ordered by face_id
  FaceGeometry geometry(std::size_t face) const;
};

/// Collective.
Side gather(const mesh::Surface& surface, const Communicator& comm);

/// A place that may carry a multiplier: a node and the faces on one side of a kink there.
struct Place {
  Local node;
  Point normal;  ///< unit; weighted so that it is exact where the faces inscribe a sphere or cylinder [Max, J. Graph. Tools 4 (1999)]
};

/// The places of a side and the place that each face corner belongs to (at faces.offset[f] + corner). Faces round a node belong together
/// if a chain of them turns by less than about 40 degrees from one to the next.
struct Places {
  std::vector<Place> all;
  std::vector<Local> of_corner;
};
Places find_places(const Side& side);

}  // namespace mortise::contact
