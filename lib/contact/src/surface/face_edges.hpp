// The faces of a side by their corners, and the edges between them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "surface/side.hpp"

namespace mortise::contact {

/// Faces of first order through the corners of a side's faces, and the edges at which two of them meet without turning by as much
/// as at a kink that needs no further look (skin.hpp).
class FaceEdges {
 public:
  struct Face {
    FaceGeometry geometry;
    Few<Local, 4> nodes;
    Point centre, normal;
    Few<std::pair<std::size_t, std::size_t>, 4> beside;  ///< a face, and the edge that leads to it
  };

  /// From node to node, the smaller first; in plane models the node twice.
  struct Edge {
    Local a, b;
    std::array<std::size_t, 2> faces;

    bool has(Local n) const { return n == a || n == b; }
  };

  /// What an edge looks like: its middle, half of its length, the mean normal there and the directions along it and across, from
  /// the first face to the other.
  struct Place {
    Point middle, normal, along, away;
    double half;
  };

  explicit FaceEdges(const Side& side);

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const Point& at(Local n) const { return side_.points[static_cast<std::size_t>(n)]; }

  Place place_of(const Edge& edge) const;
  /// How far a face reaches from an edge.
  double depth(std::size_t face, const Place& place, const Point& away) const;
  /// By how much the slopes across an edge of the curved faces there differ; none where one of the faces is of first order.
  std::optional<double> turn_of_curved(const Edge& edge, const Place& place) const;
  /// Whether two faces share a node.
  bool touch(std::size_t face, std::size_t other) const;
  /// The edges of facets that make up an edge: a node in the middle of one of second order cuts it in two.
  Few<FacetEdge, 2> facet_edges(const Edge& edge) const;

 private:
  Face corners_of_face(std::size_t f) const;
  // The direction in which the edge of a face of second order leaves `from` for `to`.
  std::optional<Point> leaves(std::size_t face, Local from, Local to) const;
  void find_edges();

  const Side& side_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
};

}  // namespace mortise::contact
