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
  struct Frame {
    Point middle, normal, along, away;
    double half;
  };

  explicit FaceEdges(const Side& side);

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const Point& at(Local n) const { return side_.points[static_cast<std::size_t>(n)]; }

  Frame frame_of(const Edge& edge) const;
  /// Of the edge from a to b, or the node a = b. `normal` and `away` may be of any length and lean to each other.
  Frame frame_between(Local a, Local b, const Point& normal, const Point& away) const;
  /// How far a face reaches from an edge.
  double depth(std::size_t face, const Frame& frame, const Point& away) const;
  /// The slope of a face by its corners, in a direction.
  static double slope(const Face& face, const Frame& frame, const Point& away)
  {
    return -face.normal.dot(away) / face.normal.dot(frame.normal);
  }
  /// The slope at which a curved face leaves its edge from a to b, or its end a = b, across; none where it is of first order.
  std::optional<double> slope_of_curved(std::size_t face, Local a, Local b, const Frame& frame) const;
  /// By how much the slopes across an edge of the curved faces there differ; none where one of the faces is of first order.
  const std::optional<double>& turn_of_curved(std::size_t edge) const { return turns_[edge]; }

  /// The most that curved faces turn by at the other edges of a face that has the edge from a to b, and at those of the faces
  /// behind them that do not touch it; where faces are triangles, of two rings of them each. Whether there are any is of those
  /// that lie across the way: beside a border there may be none.
  struct Around {
    double next = 0, beyond = 0;
    double corners = 0;  ///< the most that the faces' corners turn by at the next edges
    bool any_next = false, any_beyond = false;
    bool curved = true;  ///< all faces there are
  };
  /// Edges of `parted`, empty or one for each edge, are as a border.
  Around around(std::size_t face, Local a, Local b, const Frame& frame, const std::vector<bool>& parted = {}) const;
  /// Whether two faces share a node.
  bool touch(std::size_t face, std::size_t other) const;
  /// The edges of facets that make up an edge of a face: a node in the middle of one of second order cuts it in two.
  Few<FacetEdge, 2> facet_edges(std::size_t face, Local a, Local b) const;
  Few<FacetEdge, 2> facet_edges(const Edge& edge) const { return facet_edges(edge.faces[0], edge.a, edge.b); }

 private:
  Face corners_of_face(std::size_t f) const;
  // The direction in which the edge of a face of second order leaves `from` for `to`.
  std::optional<Point> leaves(std::size_t face, Local from, Local to) const;
  void find_edges();
  std::optional<double> turn_at(const Edge& edge) const;

  const Side& side_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<std::optional<double>> turns_;
  std::vector<double> corners_;  // of each edge, by how much the faces turn by their corners
};

}  // namespace mortise::contact
