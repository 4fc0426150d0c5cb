// Kinks that curved faces show by themselves, at the borders of a side too.
#pragma once

#include <optional>
#include <vector>

#include "surface/face_edges.hpp"

namespace mortise::contact {

/// Whether there is a kink where curved faces turn by `curved`, a difference of slopes, and their corners by `corners`; `first`,
/// `last`: around both. Faces of second order that follow a smooth surface hardly turn by themselves: on waves of three faces by
/// a third of what corners turn by there, and by half as much at least at one of two edges beside; on arcs by nothing.
bool is_kink_of_curved(double curved, double corners, const FaceEdges::Around& first, const FaceEdges::Around& last);

/// Slopes of two faces that differ by less than this leave too little between the surface through them and the faces.
inline constexpr double least_kink = 0.004;

/// The edges that one face of a side alone has. Keeps a reference to the side.
class CurvedBorders {
 public:
  struct Edge {
    std::size_t face;
    Local a, b;  ///< the same in plane models
    Few<FacetEdge, 2> parts;
  };

  explicit CurvedBorders(const Side& side);

  const std::vector<Edge>& edges() const { return edges_; }

  /// Whether an edge in a plane with this normal makes a kink with its image. False where the faces are of first order.
  bool meets_image_at_kink(const Edge& edge, const Point& normal) const;
  /// Whether an edge makes a kink with one of another side in the same place.
  bool meets_at_kink(const Edge& edge, const CurvedBorders& other, const Edge& beyond) const;

 private:
  FaceEdges all_;
  std::vector<Edge> edges_;
};

}  // namespace mortise::contact
