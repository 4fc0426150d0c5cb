// Where multipliers may sit, and the normals there.
#pragma once

#include "surface/side.hpp"

namespace mortise::contact {

/// A surface node that may carry a multiplier: a node and the faces on one side of a kink there.
struct SurfaceNode {
  Local node;
  Point normal;  ///< unit; exact where the faces inscribe a sphere or cylinder [weights of Max, J. Graph. Tools 4 (1999)], and
                 ///< where a plane runs into one
  bool third_order = false;    ///< the normal is one of third order, or exact, see fit_normals()
  Point lean = Point::Zero();  ///< by how much that of second order differs from it then
};

/// The surface nodes of a side, and the surface node that each corner of a facet (at facets.offset[f] + corner) and each node of
/// a face (at faces.offset[f] + node) belongs to. Facets round a node belong together if a chain of them turns by less than about
/// 40 degrees from one to the next; where kinks end at the node, if such a chain crosses none.
struct SurfaceNodes {
  std::vector<SurfaceNode> all;
  std::vector<Local> of_corner, of_node;
  std::vector<FacetEdge> continued;  ///< of the border, beyond which the side goes on: in its image, or across a bond; ascending

  /// At a corner of a facet.
  const SurfaceNode& at(const Side& side, std::size_t facet, std::size_t corner) const
  {
    return all[static_cast<std::size_t>(of_corner[static_cast<std::size_t>(side.facets.offset[facet]) + corner])];
  }
  const Point& normal(const Side& side, std::size_t facet, std::size_t corner) const { return at(side, facet, corner).normal; }
};

/// At the border of a surface, where faces lie on one side only, normals continue the curvature of the edges that lead inside: an
/// arc has opposite slopes at its ends.
SurfaceNodes find_surface_nodes(const Side& side);
/// The same from the points and facets of a side alone, without `of_node`, and that; `fitted`: with the normals of surfaces of
/// second order through the nodes round each, if those determine one, and not only the means of the faces' normals.
SurfaceNodes surface_nodes_of_facets(const Side& side, bool fitted = true);
void number_nodes_of_faces(const Side& side, SurfaceNodes& surface_nodes);

}  // namespace mortise::contact
