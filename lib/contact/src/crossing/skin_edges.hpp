// The edges between the facets of bodies, and where they pass through facets of others.
#pragma once

#include <array>
#include <vector>

#include "pairing/skin.hpp"

namespace mortise::contact {

/// An edge of a body's facets; in plane models a facet.
struct SkinEdge {
  int body;
  std::array<Local, 2> nodes;       ///< of the skin's side, the smaller first
  std::vector<std::size_t> facets;  ///< that have it, ascending
};

/// Of all bodies, ordered.
std::vector<SkinEdge> edges_of(const Skin& skin);

/// How far the smooth surface stands out of each facet, about: s / 2 tan(phi / 4) of a regular polygon, s the facet's size, phi
/// the largest angle between its normal and those of its neighbours; angles above 75 degrees are edges of the body. `facets`: the
/// skin's facets at some points.
std::vector<double> bulges_of(const std::vector<SkinEdge>& edges, const std::vector<FaceGeometry>& facets,
                              const std::vector<Point>& normals);

/// Appends where a line from `a` (0) to `b` (1) passes through a facet, its ends and the facet's border included. Not where it
/// runs in the facet's plane. A quadrilateral counts as two triangles.
void add_passages(const Point& a, const Point& b, const FaceGeometry& facet, std::vector<double>& passages);

}  // namespace mortise::contact
