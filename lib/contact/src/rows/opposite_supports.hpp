// What supports hold of the primary side, opposite the secondary one.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "integrals/cut_faces.hpp"
#include "mesh/instances.hpp"
#include "rows/supported_nodes.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

class OppositeSupports {
 public:
  /// All of which must outlive it. `supports` at the nodes of the primary side. `dimension`: 2 or 3. `rotation`: the primary side
  /// is rotated before it meets the secondary one, and so is what supports hold of it.
  OppositeSupports(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary, const SupportedNodes& supports,
                   Rays& rays, int dimension, const std::optional<mesh::Motion>& rotation)
      : secondary_(secondary),
        nodes_(surface_nodes),
        primary_(primary),
        supports_(supports),
        rays_(rays),
        dimension_(dimension),
        rotation_(rotation)
  {
  }

  /// Whether supports hold a node of the primary side along a direction.
  bool prescribe_node(Local node, const Point& direction) const
  {
    return supports_.holds(primary_.node_id[static_cast<std::size_t>(node)], rotated_back(direction), dimension_);
  }
  /// Whether supports hold what a line meets, along a direction; true where it meets nothing.
  bool prescribe(const Opposite& opposite, const Point& direction) const;
  /// Whether they leave next to nothing of the direction free.
  bool prescribe_all(const Opposite& opposite, const Point& direction) const;
  /// The mean of the projectors onto what they leave free there; 0 where a line meets nothing.
  Eigen::Matrix3d free_part(const Opposite& opposite) const;
  /// Whether they leave next to nothing of all directions that orthonormal ones span.
  bool prescribe_each(const Opposite& opposite, std::span<const Point> directions) const;

  /// Of a surface node, what lies opposite a place where its multipliers stand.
  using Test = std::function<bool(std::size_t node, const Opposite& opposite)>;
  /// Of each surface node whether the test holds where its multipliers stand: at the node, or, past the border of the primary
  /// side, at the points inside to which the functions of faces that it covers in part belong; of several points at all.
  std::vector<char> prescribed(CutFaces& faces, const Test& test) const;

 private:
  // Whether next to nothing of the shape functions opposite is free, where `freedom`(node) of each node is; true where there is
  // nothing opposite.
  template <class Freedom>
  bool leave_nothing_free(const Opposite& opposite, const Freedom& freedom) const;
  Point rotated_back(const Point& direction) const
  {
    return rotation_ ? Point(rotation_->rotation.transpose() * direction) : direction;
  }

  const Side& secondary_;
  const SurfaceNodes& nodes_;
  const Side& primary_;
  const SupportedNodes& supports_;
  Rays& rays_;
  int dimension_;
  std::optional<mesh::Motion> rotation_;
};

}  // namespace mortise::contact
