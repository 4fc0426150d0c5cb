// Edges of a side: where two faces meet at a kink.
#pragma once

#include <span>
#include <vector>

#include "surface_nodes.hpp"

namespace mortise::contact {

/// Of each surface node the normals of others at the same node, on the other sides of edges: of faces that stand in front of its
/// own, and whether some stand behind them.
struct Edges {
  std::vector<Few<Point, 3>> concave;
  std::vector<bool> convex;
};
Edges edges_at(const Side& side, const SurfaceNodes& surface_nodes);

/// A convex edge between two facets; in plane models a node, twice.
struct Ridge {
  FacetEdge ends;
  std::array<Point, 2> normals;  ///< unit, of the two sides there
  Point across;                  ///< unit, from the first facet to the second, normal to the edge and to the mean of the normals
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
