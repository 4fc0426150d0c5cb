// What of the primary side lies over the facets of the secondary one, along their normals: nodes and convex edges, between the
// nodes of which the gap may be least.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "search/line_of_sight.hpp"
#include "search/opposite.hpp"
#include "search/tree.hpp"
#include "surface/edges.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

class OverFacets {
 public:
  /// All of which must outlive it; `tree` has the facets of the primary side. Where an obstacle stands for that, it has none, and
  /// nothing lies over any facet.
  OverFacets(const Side& secondary, const Side& primary, const SurfaceNodes& primary_nodes, const Tree& tree,
             const LineOfSight& sight, const Rays& rays, double reach);

  /// Of nodes over a facet, within reach, where this holds of the facet's shape functions there:
  using Counts = std::function<bool(const Eigen::Vector4d&)>;
  /// the least gap, infinite if there are none;
  double least_gap(std::size_t facet, const Counts& counts);
  /// of those with a gap of at most `most`, the one next to `from`, a node of the facet.
  struct NearNode {
    Eigen::Vector4d shape;  ///< of the facet
    double distance;        ///< from `from`
    double size;            ///< of a facet of the primary side that has it
  };
  std::optional<NearNode> nearest_node(std::size_t facet, const Point& from, double most, const Counts& counts);

  /// Where a convex edge comes nearer to a facet than the faces on both sides of it; of such places the one next to `from`, a
  /// node of the facet. An edge that descends has its lower end alone. A border counts where the primary side has other faces
  /// beyond: where it has none the facet is covered up to the border, and its multipliers have points there.
  struct OnRidge {
    Eigen::Vector4d shape;  ///< of the facet
    double distance;        ///< from `from`
  };
  std::optional<OnRidge> nearest_on_ridge(std::size_t facet, const Point& from);

 private:
  struct NodeOver {
    Local node;
    Eigen::Vector4d shape;
    Point at;              // under it, in the facet
    double distance, gap;  // from there, without and with the facet's bulge
    double size;           // of a facet of the primary side that has it
  };
  struct RidgeOver {
    Local ridge, facet;  // one of those that it is at
  };
  // All nodes and ridges that face a facet, those of nodes that lie over it; found once.
  const std::vector<NodeOver>& nodes_over(std::size_t facet);
  const std::vector<RidgeOver>& ridges_over(std::size_t facet);
  const std::vector<int>& met_by(std::size_t facet);
  bool is_hidden(std::size_t facet, const NodeOver& node) const;
  // Whether the primary side lies over a place of a facet.
  bool is_covered(std::size_t facet, const Point& at);

  const Side& secondary_;
  const Side& primary_;
  const SurfaceNodes& primary_nodes_;
  const Tree& tree_;
  const LineOfSight& sight_;
  const Rays& rays_;
  double reach_;
  Ridges ridges_;                                                   // of the primary side
  std::vector<std::optional<std::vector<NodeOver>>> nodes_over_;    // of each facet that was asked about
  std::vector<std::optional<std::vector<RidgeOver>>> ridges_over_;  // the same
  std::vector<int> met_;                                            // facets of the primary side, of the facet at work
};

}  // namespace mortise::contact
