// Edges of a side: where two faces meet at a kink.
#pragma once

#include <span>
#include <vector>

#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// Slopes of two sides that differ by less are parallel.
inline constexpr double parallel_slopes = 0.03;
/// The same at a border, whose normals are continued over a face that turns by so much.
inline double parallel_over(double turn)
{
  return parallel_slopes + 0.5 * turn;
}

/// Of each surface node the normals of others at the same node, on the other sides of edges; whether faces there stand behind its
/// own; and on a border where the side ends the unit vector in the tangent plane that leads out.
struct Edges {
  std::vector<Few<Point, 3>> beside;
  std::vector<bool> convex;
  std::vector<Point> outward;

  /// Whether a surface node with the normal n, along which a side with the normal m lies opposite, is on a convex edge: behind
  /// one, or on a border beyond which that would come nearer still. Slopes that differ by less than `parallel` are none.
  bool is_edge(std::size_t surface_node, const Point& n, const Point& m, double parallel) const
  {
    return convex[surface_node] || (n + m).dot(outward[surface_node]) < -parallel;
  }
};
Edges edges_at(const Side& side, const SurfaceNodes& surface_nodes);

/// The largest change of the normals along the edges of a facet, per length.
double curvature_of(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet);

/// A convex edge between two facets, or of the border; in plane models a node, twice.
struct Ridge {
  FacetEdge ends;
  std::array<Point, 2> normals;  ///< unit, of the two sides there; on the border twice the same
  Point across;                  ///< unit, from the first facet to the second or outward, normal to the edge and the mean normal
  bool border = false;
};

struct Ridges {
  std::vector<Ridge> all;
  std::vector<Local> offset, of;  ///< of each facet
  std::span<const Local> of_facet(std::size_t facet) const
  {
    const auto begin = static_cast<std::size_t>(offset[facet]), end = static_cast<std::size_t>(offset[facet + 1]);
    return std::span(of).subspan(begin, end - begin);
  }
};
Ridges find_ridges(const Side& side, const SurfaceNodes& surface_nodes);

}  // namespace mortise::contact
