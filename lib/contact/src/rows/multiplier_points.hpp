// Where the multipliers of a contact act, and the gap there.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "integrals/cut_faces.hpp"
#include "search/nearest_points.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

class MultiplierPoints {
 public:
  /// All of which must outlive it; `faces` sorted by nodes before it is asked. `nearest`: see nearest_points(); or none.
  MultiplierPoints(const Side& secondary, const SurfaceNodes& surface_nodes, CutFaces& faces, const Rays& rays,
                   const std::vector<NearestPoint>& nearest)
      : secondary_(secondary), nodes_(surface_nodes), faces_(faces), rays_(rays), nearest_(nearest)
  {
  }

  /// The point of a place's multiplier and the secondary side's normal there: at the node, unless it was moved to where
  /// the other side comes nearest, or into what is covered.
  std::pair<Point, Point> at(std::size_t place);

  /// Whether a place's row means the field there: at a middle node of a face of second order that is one piece it means a control
  /// value, see multiplier_basis().
  bool means_field(std::size_t place);

  /// How much is left of the way from its node to the next ones, in the direction in which the point was moved from the node into
  /// what is covered: 1 at the node, little where the covered strip is narrow. 0 at a corner of the primary side.
  double room(std::size_t place);

  /// The gap between the smooth surfaces at the point itself, along the direction of contact. Its mean over the dual basis, which
  /// has negative parts, would see an overlap of a twelfth of curvature times cell size squared between surfaces that only touch;
  /// that `mean` is left for points that look past the border of the primary side.
  /// `gap_of`: what the contact starts with where a line meets something.
  double gap(std::size_t place, const Point& direction, double mean, const Rays::GapOf& gap_of = {});

  /// Whether nearest_points() moved it.
  bool moved(std::size_t place) const { return !nearest_.empty() && !faces_.is_corner(place) && nearest_[place].moved(); }

 private:
  std::pair<Point, Point> point_at(const Rays::FacetPoint& place) const;
  std::optional<Rays::FacetPoint> nearest_place(std::size_t place);

  const Side& secondary_;
  const SurfaceNodes& nodes_;
  CutFaces& faces_;
  const Rays& rays_;
  const std::vector<NearestPoint>& nearest_;
};

}  // namespace mortise::contact
