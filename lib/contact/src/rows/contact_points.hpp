// Which places between nodes, where the other side comes nearest, have rows of their own beside those of the nodes.
//
// Those in faces that one body of the other side covers as a whole: all nodes round the place then have rows that mean one body.
// Faces of second order round the place are cut into their facets, so that the rows mean the field at their nodes and not control
// values. Elsewhere, as opposite rollers smaller than a face, and where the place is next to a node, the multiplier of the
// nearest node moves to the place.
#pragma once

#include <functional>
#include <vector>

#include "base/communicator.hpp"
#include "integrals/cut_faces.hpp"
#include "search/nearest_points.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

struct ContactPoint {
  std::size_t surface_node;  ///< the nearest
  Global node;               ///< there
  Rays::FacetPoint where;
  Point at, normal;             ///< of the secondary side
  std::vector<Global> corners;  ///< of the facet
  std::vector<Point> facet;     ///< where these are
  std::vector<Global> round;    ///< nodes of the faces round these, ascending; of a place on an edge of the border those along it
  Point edge = Point::Zero();   ///< the direction of the border, if the place is on it
};

/// What the other side covers of a face.
struct Cover {
  double part = 0;  ///< of its area
  int body = -1;    ///< of the other side, one that hangs together; -1: several, or none
};

struct ContactPoints {
  std::vector<ContactPoint> places;  ///< those whose nodes are this rank's own
  std::vector<char> in_facets;       ///< of each face of the secondary side: of second order and round a place
};

/// Takes such places out of `nearest`: their nodes keep rows of their own. Collective.
ContactPoints take_contact_points(std::vector<NearestPoint>& nearest, const Side& secondary, const SurfaceNodes& surface_nodes,
                                  const CutFaces& faces, const std::vector<char>& own,
                                  const std::function<Cover(std::size_t face)>& cover, const Communicator& comm);

}  // namespace mortise::contact
