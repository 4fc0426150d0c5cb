#include "rows/opposite_supports.hpp"

#include <cmath>

#include "rows/rows.hpp"

namespace mortise::contact {

namespace {

// Of the shape functions opposite: on curved sides a line along the normal meets the other side beside what is held.
constexpr double next_to_nothing = 0.1;

}  // namespace

template <class Freedom>
bool OppositeSupports::leave_nothing_free(const Opposite& opposite, const Freedom& freedom) const
{
  if (!std::isfinite(opposite.gap)) return true;
  const auto nodes = primary_.facets[opposite.facet];
  double free = 0, all = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double part = std::abs(opposite.hit.shape[static_cast<Eigen::Index>(k)]);
    free += part * freedom(primary_.node_id[static_cast<std::size_t>(nodes[k])]);
    all += part;
  }
  return free < next_to_nothing * all;
}

bool OppositeSupports::prescribe(const Opposite& opposite, const Point& direction) const
{
  const Point there = rotated_back(direction);
  return leave_nothing_free(opposite, [&](Global node) { return supports_.holds(node, there, dimension_) ? 0.0 : 1.0; });
}

bool OppositeSupports::prescribe_all(const Opposite& opposite, const Point& direction) const
{
  const Point there = rotated_back(direction);
  return leave_nothing_free(opposite, [&](Global node) { return supports_.freedom(node, there, dimension_); });
}

Eigen::Matrix3d OppositeSupports::free_part(const Opposite& opposite) const
{
  Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
  if (!std::isfinite(opposite.gap)) return free;
  const auto nodes = primary_.facets[opposite.facet];
  double all = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double part = std::abs(opposite.hit.shape[static_cast<Eigen::Index>(k)]);
    free += part * supports_.free_part(primary_.node_id[static_cast<std::size_t>(nodes[k])], dimension_);
    all += part;
  }
  if (rotation_) free = (rotation_->rotation * free * rotation_->rotation.transpose()).eval();
  return free / all;
}

bool OppositeSupports::prescribe_each(const Opposite& opposite, std::span<const Point> directions) const
{
  return directions_of_most(free_part(opposite), directions, next_to_nothing).empty();
}

std::vector<char> OppositeSupports::prescribed(CutFaces& faces, const Test& test) const
{
  std::vector<char> result;
  for (std::size_t p = 0; p < nodes_.all.size(); ++p) result.push_back(test(p, rays_.meet(p)));
  for (const std::size_t f : faces.round())
    for (const std::size_t i : faces.pieces(f)) {
      const auto piece = faces.piece(i);
      if (piece.point_facet.empty()) continue;
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
        const Local facet = piece.point_facet[static_cast<std::size_t>(k)];
        const auto p = faces.surface_node_of(f, piece, k);
        if (facet < 0 || !(piece.covered[k] > 0) || !result[p] || std::isfinite(rays_.meet(p).gap)) continue;
        const auto corners = secondary_.facets[static_cast<std::size_t>(facet)];
        Point at = Point::Zero();
        for (std::size_t c = 0; c < corners.size(); ++c)
          at += piece.points(k, static_cast<Eigen::Index>(c)) * secondary_.points[static_cast<std::size_t>(corners[c])];
        result[p] = test(p, rays_.met_from(p, at, nodes_.all[p].normal));
      }
    }
  return result;
}

}  // namespace mortise::contact
