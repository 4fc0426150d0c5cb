// The facets round a surface node, and where in them a tangential step from it leads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "surface/side.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

class FacetsRound {
 public:
  struct Corner {
    std::size_t facet, corner;
  };
  /// A place in a facet, near one of its corners or beyond the border.
  struct PointInFacet {
    std::size_t facet, corner;
    Eigen::Vector4d shape;
  };

  /// Those of `faces` alone. The side and its surface nodes outlive it.
  FacetsRound(const Side& side, const SurfaceNodes& surface_nodes, const std::vector<std::size_t>& faces);

  /// Corners of facets at a surface node.
  std::span<const Corner> round(std::size_t p) const { return std::span(corners_).subspan(first_[p], first_[p + 1] - first_[p]); }
  std::size_t surface_node(std::size_t facet, std::size_t corner) const
  {
    return static_cast<std::size_t>(nodes_.of_corner[static_cast<std::size_t>(side_.facets.offset[facet]) + corner]);
  }

  /// The step from a corner of a facet to a place in it, as of shape_beside().
  Point shift_to(const Corner& from, const Eigen::Vector4d& shape) const;
  /// The facet round a node that a step from it leads into. A step along the edge between two of them may miss both, which lie in
  /// other planes: it is in the one that it misses less.
  std::optional<PointInFacet> holds(std::size_t p, const Point& shift) const;
  /// Whether a facet shares its edge from a surface node to another node with a facet round that surface node.
  bool shared(std::size_t p, std::size_t facet, Local node) const;
  /// Whether no other node of the facet is nearer; of two at the same distance the one with the smaller number.
  bool is_nearest(const PointInFacet& place) const;
  /// Of the step to a place: of two nodes at the same distance none may be nearer by rounding, its function would push with a
  /// sign of its own.
  double part_within(const PointInFacet& place) const;

 private:
  // Whether a place outside of a facet round a node lies across edges at the node alone, which other facets have as well.
  bool beside_shared_edge(std::size_t p, const PointInFacet& place) const;

  const Side& side_;
  const SurfaceNodes& nodes_;
  std::vector<std::size_t> first_;  // of each surface node in corners_
  std::vector<Corner> corners_;
};

/// The shape functions of a facet at the tangential step `shift` from one of its corners, also beyond its border.
Eigen::Vector4d shape_beside(const Side& side, std::size_t facet, std::size_t corner, const Point& shift);

}  // namespace mortise::contact
