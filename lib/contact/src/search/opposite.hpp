// What lies opposite a surface node, along its normal: a smooth primary side or a rigid obstacle.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "contact/obstacle.hpp"
#include "search/line_of_sight.hpp"
#include "search/tree.hpp"
#include "surface/bulge.hpp"
#include "surface/edges.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

struct Opposite {
  double gap = std::numeric_limits<double>::infinity();  ///< between the smooth surfaces; infinite: nothing is there
  std::size_t facet = 0;                                 ///< of the primary side
  Hit hit;
};

class Rays {
 public:
  /// All of which must outlive it; `tree` has the facets of the primary side. Turns the normals of the surface nodes at which an
  /// obstacle lies opposite into the direction of contact.
  Rays(const Side& secondary, SurfaceNodes& surface_nodes, const Side& primary, const SurfaceNodes& primary_nodes,
       const Tree& tree, const LineOfSight& sight, const std::optional<Obstacle>& obstacle, double reach);

  /// What is next to a surface node on the line along its normal, both ways, within reach; looked up once for each surface node.
  /// An obstacle is met at any distance.
  const Opposite& meet(std::size_t surface_node);
  bool meets(std::size_t surface_node) { return std::abs(meet(surface_node).gap) <= reach_; }

  /// Whether one of the edges of a face of second order comes nearest to the other side between its ends. The control value of
  /// its middle then lies below all gaps of the edge: of a parabola that touches a plane it is an overlap of an eighth of
  /// curvature times length squared.
  bool nearest_within(std::size_t face);

  /// How the smooth sides lie to each other on the line along the secondary side's normal: the sum of their normals, zero where
  /// they are parallel, and that of their curvatures' sizes. None if the line meets nothing within reach.
  struct Tilt {
    Point difference;
    double curvature;
  };
  std::optional<Tilt> tilt(std::size_t surface_node);
  /// The same where the shape functions of a facet are `shape`, near a surface node.
  std::optional<Tilt> tilt(std::size_t surface_node, std::size_t facet, const Eigen::Vector4d& shape) const;
  bool obstacle() const { return obstacle_.has_value(); }
  double size_of(const Opposite& opposite) const { return primary_.geometry(opposite.facet).size(); }
  /// The normal of the secondary side itself, also opposite an obstacle: at a surface node, at the corner of a facet.
  const Point& own_normal(std::size_t surface_node) const { return own_normal_[surface_node]; }
  const Point& own_normal(std::size_t facet, std::size_t corner) const
  {
    const auto begin = static_cast<std::size_t>(secondary_.facets.offset[facet]);
    return own_normal_[static_cast<std::size_t>(nodes_.of_corner[begin + corner])];
  }

  /// What stands out of a facet of the secondary side, with these normals.
  Bulge own_bulge(std::size_t facet) const;

  /// The direction of contact at a point of the secondary side near a surface node, whose normal there is given: between the two
  /// sides' normals, the nearer to that of the flatter side the more it is flatter, weights being the other side's curvature. So
  /// both sides mean the same direction, and a curved body on a flat one is not sheared. Convex edges are curved most, see
  /// Edges::is_edge(): there it is the normal of what they touch, unless that is an edge, too. The given normal where nothing
  /// lies opposite.
  Point direction(std::size_t surface_node, const Point& at, const Point& normal) const;

  /// What the line from there along that direction meets; nothing where the gap is infinite.
  Opposite met_from(std::size_t surface_node, const Point& at, const Point& direction) const
  {
    return shoot_past(surface_node, at, direction, 2 * reach_, past_[surface_node]);
  }

  /// How far the smooth surface stands out of the facet that is met, where it is met; 0 where nothing is.
  double rise_of(const Opposite& met) const;

  /// Whether a surface node is in the middle of an edge or a face, where rows see control values.
  bool at_middle(std::size_t surface_node) const { return face_of_middle_[surface_node].first >= 0; }

  /// Takes another gap than that of the meshes where a line from a surface node meets something.
  using GapOf = std::function<double(std::size_t surface_node, const Opposite&)>;
  /// The gap along a direction of contact at a surface node, as the rows see it: in the middle of edges and faces as a control
  /// value, see multiplier_basis(). Infinite if one of the lines meets nothing within twice the reach.
  double gap(std::size_t surface_node, const Point& direction, const GapOf& gap_of = {}) const;
  /// The same at a point of a facet, behind which the smooth surface stands out, that stands for a surface node. Lines that just
  /// miss the other side meet its faces continued.
  struct FacetPoint {
    std::size_t facet;
    Eigen::Vector4d shape;  ///< of the facet
  };
  double gap(std::size_t surface_node, const FacetPoint& point, const Point& direction, const GapOf& gap_of = {}) const;
  /// The normal of the secondary side itself there.
  Point own_normal(const FacetPoint& point) const;

 private:
  // What a line meets first, both ways, of facets for which `counts` holds, or all, and sees.
  using Counts = std::function<bool(std::size_t facet)>;
  Opposite shoot(const Point& from, const Point& direction, double length, const Counts& counts) const;
  // The same; a line that meets nothing meets the nearest face continued, if it misses it by less than `past`.
  Opposite shoot_past(const Point& from, const Point& direction, double length, double past, const Counts& counts = {}) const;
  // The same from or for a surface node. At an edge of the secondary side what faces the other side of the edge better is for the
  // surface node there: what is smaller than its hole lies in a corner with an edge, whose other side the line meets.
  Opposite shoot_past(std::size_t surface_node, const Point& from, const Point& direction, double length, double past) const;
  Point primary_normal(const Opposite& opposite) const;
  double part_on_edges(const Opposite& opposite, const Point& normal) const;
  Point direction_to_obstacle(std::size_t surface_node, const SignedDistance& closest, const Point& normal) const;
  double distance_to_obstacle(const Point& at, const Point& direction) const;
  Tilt tilt_to(std::size_t surface_node, const Point& own, const Opposite& opposite) const;
  const Side& secondary_;
  const SurfaceNodes& nodes_;
  const Side& primary_;
  const SurfaceNodes& primary_nodes_;
  const Tree& tree_;
  const LineOfSight& sight_;
  double reach_;
  const std::optional<Obstacle>& obstacle_;
  std::vector<Point> own_normal_;                        // of each surface node
  std::vector<double> curvature_, past_;                 // of each surface node
  std::vector<double> distance_;                         // of each surface node from the obstacle, if there is one
  Edges edges_, primary_edges_;                          // of both sides
  std::vector<std::pair<Local, Local>> face_of_middle_;  // of each surface node: a face and the node in it, if that is no corner
  std::vector<Opposite> met_;
  std::vector<Local> met_index_;    // of each surface node its entry in met_, or -1
  mutable std::vector<int> swept_;  // facets of the primary side that the line at work may meet
};

}  // namespace mortise::contact
