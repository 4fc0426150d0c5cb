// The smooth surface behind facets.
#pragma once

#include <array>
#include <span>

#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// How far the smooth surface through the nodes stands out of a face (positive outwards) at reference shape values N, along the
/// mean of the normals there: 2 h / (1 + q) with q = |sum N_i n_i| and, with the slopes s_ij = n_i.(x_i - x_j) of the surface
/// over the line from corner i to j times its length, h = sum_{i<j} N_i N_j (s_ij + s_ji) / 2 + sum_{edges ij} (s_ij - s_ji) / 2
/// A B (A - B) C, where A and B belong to the ends of an edge and C to the edge: cubic along edges. The first sum is exact for
/// surfaces of second order; both are for those of third on parallelograms, but for a bubble on triangles, which makes the third
/// derivatives least. On a sphere or a cylinder of radius R the place sum N_i x_i lies R q from the centre, and h = R (1 - q^2) /
/// 2: the result R (1 - q) is exact, while the facets alone are wrong by their sagitta.
class Bulge {
 public:
  /// `cubic`: the normals are of third order, or exact. Else the second sum is left out: where normals of second order lean, they
  /// do so alike at both ends of an edge, and the first sum is of third order.
  Bulge(const FaceGeometry& face, std::span<const Point> normals, bool cubic);
  /// Cubic if all normals of a facet are of third order; else with those of second order. `normals`: of the surface nodes, if not
  /// their own.
  Bulge(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet, std::span<const Point> normals = {});
  double operator()(const Eigen::Vector4d& shape) const;
  /// The same along a line with a unit vector, whatever its sense, that need not be the normal.
  double along(const Point& line, const Eigen::Vector4d& shape) const;

 private:
  struct Corners {
    Few<Point, 4> normals;
    bool cubic;
  };
  static Corners corners(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet, std::span<const Point> normals);
  Bulge(const FaceGeometry& face, const Corners& corners)
      : Bulge(face, {corners.normals.begin(), corners.normals.size()}, corners.cubic)
  {
  }
  double height(const Eigen::Vector4d& shape) const;
  Point mean_normal(const Eigen::Vector4d& shape) const;

  std::size_t n_;
  std::array<std::array<double, 4>, 4> mean_{};  // of the slopes at two corners
  std::array<double, 4> odd_{};                  // half of what they differ by, at the edge from each corner to the next
  double bubble_ = 0;
  std::array<Point, 4> normal_;  // at each corner
};

}  // namespace mortise::contact
