// What supports hold at the nodes of a side, and what they leave free there.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"

namespace mortise::contact {

/// Part of a direction, or of a row: what supports leave less of they hold, their directions at two nodes being known no better.
/// A row of what is left would tear the sides apart.
inline constexpr double nothing_moves = 1e-5;
/// Of a normal: supports that leave no more of it hold it. A row along it would bear what acts along the rest with at least
/// twenty times that, and push the supports apart with it.
inline constexpr double hardly_moves = 0.05;

/// The supports of all ranks, those of a node on rank node % ranks.
class SupportDirectory {
 public:
  /// `prescribed` and `skew_supports` of this rank. Collective.
  SupportDirectory(std::span<const constraint::PrescribedDof> prescribed, std::span<const constraint::SkewSupport> skew_supports,
                   const Communicator& comm);

 private:
  friend class SupportedNodes;
  std::vector<constraint::PrescribedDof> prescribed_;
  std::vector<constraint::SkewSupport> skew_supports_;
};

/// The supports at the nodes of a side.
class SupportedNodes {
 public:
  /// `nodes` are those that this rank asks about. Collective.
  SupportedNodes(const SupportDirectory& directory, const std::vector<Global>& nodes, const Communicator& comm);

  /// Whether supports hold none of them.
  bool empty() const { return prescribed_.empty() && skew_supports_.empty(); }
  /// Null where the component is free.
  const constraint::PrescribedDof* find(Global node, int component) const;
  /// The directions that are prescribed there and are no axes.
  std::span<const constraint::SkewSupport> skew_supports(Global node) const;
  /// Whether any of them has a part along a direction.
  bool holds(Global node, const Point& direction, int dimension) const;
  /// The length of what they leave free of a unit vector there.
  double freedom(Global node, const Point& direction, int dimension) const;
  /// The projector onto what they leave free there; in plane models of the plane.
  Eigen::Matrix3d free_part(Global node, int dimension) const;

 private:
  std::vector<constraint::PrescribedDof> prescribed_;
  std::vector<constraint::SkewSupport> skew_supports_;
};

Point along(const constraint::SkewSupport& skew_supports);

/// The frame of a surface node: the tangents that supports leave free; nothing if the normal itself is prescribed.
struct Directions {
  bool free_normal = true;
  std::vector<Point> tangents;
};
Directions directions(const Point& normal, const std::array<bool, 3>& prescribed,
                      std::span<const constraint::SkewSupport> skew_supports, int dimension);
/// What the tangents of a normal lack of all directions in the surface.
std::vector<Point> other_tangents(const Point& normal, std::span<const Point> tangents, int dimension);

}  // namespace mortise::contact
