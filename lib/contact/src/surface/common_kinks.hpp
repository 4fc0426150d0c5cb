// Edges of two sides that lie upon each other.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/types.hpp"

namespace mortise::contact {

/// An edge at which a side turns.
struct TurnedEdge {
  /// The faces of a side on one side of the edge.
  struct Wing {
    Point away = Point::Zero(), far = Point::Zero();  ///< across the edge; the middle of the first one's nodes beyond it
    double depth = 0, slope = 0;                      ///< how far that reaches, and how it rises along the edge's normal
    double next = 0;                                  ///< how much more the next row does; 0 if there is none
  };

  std::size_t edge;             ///< its number
  Point middle, along, normal;  ///< `along` is 0 in plane models
  double half;                  ///< of its length
  double depth;                 ///< how far the smaller face beside it reaches
  double turn;                  ///< by the corners of the faces, a difference of slopes, positive in a valley
  std::array<Wing, 2> wings = {};
};

/// The places in `mine` of those that one of `others` lies upon, a valley upon a ridge, and turns by about as much: their middles
/// less than a twentieth of a face apart across, and no farther along than the edges reach.
std::vector<std::size_t> lie_upon_others(std::span<const TurnedEdge> mine, std::span<const TurnedEdge> others);

/// Of these, those whose faces tell that there is a kink. Beside it the nodes of a small face lie on a large one of the other
/// side but for the curve behind, which turns by `next` from face to face; on a smooth surface they lie beyond it, by the curve
/// that turns by half of `turn` at the edge. They are to be four times nearer to the former. Where faces are of one size nothing
/// tells.
std::vector<std::size_t> share_kinks(std::span<const TurnedEdge> mine, std::span<const TurnedEdge> others);

}  // namespace mortise::contact
