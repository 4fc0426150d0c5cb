// The functions of a face of second order that the primary side covers in part.
#pragma once

#include <span>
#include <vector>

#include "surface/side.hpp"

namespace mortise::contact {

/// Parts of a face or a facet below this are slits between faces that do not quite meet.
inline constexpr double slit = 1e-4;

/// The part of a facet that a primary facet covers: convex and counter-clockwise in the plane of the face.
struct CoveredPart {
  Local facet;
  Polygon polygon;
};

/// A corner of the common base inside a secondary face or on its edge, see base_corners.hpp.
struct BaseCorner {
  Plane at;
  Local facet;
  Local number;  ///< the primary side's node, or, of a crossing of both borders, a number of its own after all nodes
};

/// Functions theta_k that belong to points x_k of the covered part: theta_k(x_l) = delta_kl, sum theta = 1, sum theta_k x_k = x
/// in the plane of the face. So each dual function has its resultant at its point, and pressures that are nowhere negative can
/// have theirs anywhere between the points. These are the nodes that are covered, the corners of the covered part's convex hull,
/// which stand for nodes that are not, and for what nodes are left the next covered points, if they are far from the others.
/// Between the points the functions are linear on the triangles of Delaunay; where points lie on one circle they are the mean
/// over all such triangles, which keeps symmetry.
class CoveredBasis {
 public:
  /// `nodes`: of the face, in its plane. `parts` must not be empty; `samples` are integration points on them. `corners` have
  /// functions of their own, numbered after those of the nodes, as long as there are no more than `most_functions` in all; then
  /// those of nodes that are not covered.
  CoveredBasis(mesh::CellType type, std::span<const Plane> nodes, std::span<const CoveredPart> parts,
               std::span<const Sample> samples, std::span<const BaseCorner> corners = {});

  /// How many functions there may be: of the nodes, and those of corners.
  std::size_t size() const { return points_.size(); }
  /// Values at a place of the plane, of all of these: 0 for those that have no function.
  FaceShape operator()(const Plane& x) const;
  /// Whether a node has a function.
  bool has(std::size_t node) const { return facet_[node] >= 0; }
  Plane point(std::size_t node) const { return points_[node]; }
  /// The facet on which the point lies.
  Local facet(std::size_t node) const { return facet_[node]; }

 private:
  struct Triangle {
    std::array<std::size_t, 3> nodes;
    Eigen::Matrix3d inverse;  // of (1, x) to the three functions
  };
  struct Corner {
    Plane at;
    Local facet;
    bool node;  // is a covered node
  };

  Plane scaled(const Plane& x) const { return (x - low_).cwiseQuotient(extent_); }
  void take_nodes();
  void add(std::span<const BaseCorner> corners);
  std::vector<Corner> hull() const;
  void take_corners(std::span<const BaseCorner> base);
  void fill_up();
  void triangulate();
  void take_one();
  bool drop_empty(std::span<const Sample> samples);

  mesh::CellType type_;
  std::span<const Plane> nodes_;
  std::vector<CoveredPart> parts_;
  double length_ = 0;   // of the face
  Plane low_, extent_;  // the box round the covered part
  Few<Plane, most_functions> points_;
  Few<Local, most_functions> facet_;  // -1: no function
  std::vector<Triangle> triangles_;
};

}  // namespace mortise::contact
