// Rows at places between nodes, where the other side comes nearest.
//
// Nodes alone see nothing of a contact narrower than a face. In a contact wider than that they press themselves, and a row that
// stood in for one of them would take what belongs to all round it. So where the faces are covered as a whole, such a place has a
// row of its own beside those of the nodes, a combination of them that is exact for polynomials p of second order in the tangent
// plane, and for its bound the gap of the smooth surfaces there:
//
//     row = sum w_i row_i,    sum w_i p(x_i) = p(x).
//
// Where the nodes round the place touch they say what its row says, and its multiplier is none. Where they are open it presses
// alone, with the forces w_i on the nodes [moving least squares: Lancaster and Salkauskas, Math. Comp. 37 (1981)].
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "cut_faces.hpp"
#include "nearest_points.hpp"
#include "opposite.hpp"

namespace mortise::contact {

struct PlaceBetween {
  std::size_t surface_node;   ///< the nearest
  Global node;                ///< there
  Rays::FacetPoint where;
  Point at, normal;           ///< of the secondary side
  double size;                ///< of the facet
  std::vector<Global> round;  ///< nodes whose rows it may be made of: of the faces round those of its own face; ascending
};

/// Of the places of `nearest` those in faces that are covered as a whole, all of whose nodes then keep rows of their own: they are
/// no places of `nearest` any more. Those of this rank's `own` nodes are returned. Of faces of first order.
std::vector<PlaceBetween> take_places_between(std::vector<NearestPoint>& nearest, const Side& secondary,
                                              const SurfaceNodes& surface_nodes, const CutFaces& faces, const std::vector<char>& own,
                                              const std::function<bool(std::size_t face)>& covered);

struct RowsBetween {
  int contact;       ///< ContactNode::contact
  int dimension;     ///< 2 or 3
  bool tangents;     ///< friction has rows as well
  /// The bound of the normal row along this direction, a length; not finite where nothing lies opposite.
  std::function<double(const PlaceBetween&, const Point& direction)> gap;
};

/// Adds the rows of this rank's `places`, once those of the contact's nodes stand in `contacts`, from its `first` node on.
/// Collective.
void add_rows_between(std::span<const PlaceBetween> places, std::size_t first, const RowsBetween& what,
                      constraint::Contacts& contacts, const Communicator& comm);

/// Weights w of N points (2 x N, coordinates from a place, in units of the distance that counts as near; in one dimension the
/// second are 0) with sum w_i p(x_i) = p(0) for polynomials of second order, or of first if points do not tell those apart; those
/// of which sum w_i^2 exp |x_i|^2 is least. Empty if there are none.
Eigen::VectorXd weights_between(const Eigen::Matrix2Xd& x, int dimension);

}  // namespace mortise::contact
