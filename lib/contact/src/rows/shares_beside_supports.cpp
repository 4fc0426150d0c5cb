#include "rows/shares_beside_supports.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::contact {

namespace {

constexpr double alike = 1e-3;      // sine between directions that count as one
constexpr double in_surface = 0.7;  // of a direction along the normal

bool same(const Point& a, const Point& b)
{
  return a.cross(b).norm() < alike;
}

// The directions in the surface along which supports hold a surface node and what lies opposite.
template <class HeldOpposite>
Few<Point, 3> held_on_both_sides(const SurfaceNode& node, Global id, std::size_t p, const SupportedNodes& supports,
                                 const HeldOpposite& held_opposite, int dimension)
{
  Few<Point, 3> result;
  const auto take = [&](const Point& axis) {
    if (result.size() < 3 && std::abs(axis.dot(node.normal)) < in_surface && held_opposite(p, axis)) result.push_back(axis);
  };
  for (int c = 0; c < dimension; ++c)
    if (supports.find(id, c)) take(Point::Unit(c));
  for (const auto& skew : supports.skew_supports(id)) take(along(skew));
  return result;
}

}  // namespace

SharesBesideSupports::SharesBesideSupports(const Side& secondary, const SurfaceNodes& nodes, CutFaces& faces,
                                           const SupportedNodes& supports, std::span<const char> kept,
                                           const HeldOpposite& held_opposite, int dimension)
    : secondary_(&secondary), given_(nodes.all.size())
{
  if (supports.empty()) return;
  for (std::size_t p = 0; p < given_.size(); ++p)
    given_[p] = held_on_both_sides(nodes.all[p], secondary.node_id[static_cast<std::size_t>(nodes.all[p].node)], p, supports,
                                   held_opposite, dimension);
  const auto takes = [&](std::size_t place, const Point& axis) {
    return kept[place] && (faces.is_corner(place) || !gives(place, axis));
  };
  const auto others = [&](std::size_t face, const PieceStore::View& piece, const Point& axis) {
    Few<char, most_functions> here;
    for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
      here.push_back(piece.covered[k] > 0 && takes(faces.place_of(face, piece, k), axis));
    return here;
  };
  // A node of a face that has nobody to take over along an axis keeps its share; what it has left elsewhere it keeps as well.
  std::vector<std::pair<std::size_t, Point>> kept_shares;
  for (const std::size_t f : faces.round())
    for (const Point& axis : axes_of(f, faces))
      for (const std::size_t i : faces.pieces(f)) {
        const auto piece = faces.piece(i);
        const auto here = others(f, piece, axis);
        if (piece.covered.sum() > 0 && (!piece.point_facet.empty() || std::ranges::find(here, 1) == here.end()))
          for (const Local p : faces.surface_nodes_of(f)) kept_shares.emplace_back(static_cast<std::size_t>(p), axis);
      }
  for (const auto& [p, axis] : kept_shares) {
    Axes rest;
    for (const Point& given : given_[p])
      if (!same(given, axis)) rest.push_back(given);
    given_[p] = rest;
  }
  for (const std::size_t f : faces.near())
    for (const Point& axis : axes_of(f, faces))
      for (const std::size_t i : faces.pieces(f)) {
        const auto piece = faces.piece(i);
        if (!(piece.covered.sum() > 0)) continue;
        other_.add(piece);
        auto copy = other_[other_.size() - 1];
        make_dual(copy, others(f, piece, axis));
        others_.push_back({f, i, other_.size() - 1, axis});
      }
}

bool SharesBesideSupports::gives(std::size_t p, const Point& direction) const
{
  return p < given_.size() && std::ranges::any_of(given_[p], [&](const Point& axis) { return same(axis, direction); });
}

Point SharesBesideSupports::rest_of(std::size_t p, Point direction) const
{
  if (p >= given_.size() || given_[p].empty()) return direction;
  for (const Point& axis : given_[p]) direction -= direction.dot(axis) * axis;
  return direction.normalized();
}

// Along which nodes of a face give, each once.
SharesBesideSupports::Axes SharesBesideSupports::axes_of(std::size_t face, const CutFaces& faces) const
{
  Axes result;
  for (const Local p : faces.surface_nodes_of(face))
    for (const Point& axis : given_[static_cast<std::size_t>(p)])
      if (result.size() < 3 && std::ranges::none_of(result, [&](const Point& other) { return same(axis, other); }))
        result.push_back(axis);
  return result;
}

void SharesBesideSupports::take_functions(CutFaces& faces)
{
  for (const auto& other : others_) {
    const auto now = faces.piece(other.piece), then = other_[other.copy];
    const auto nodes = secondary_->faces[other.face];
    for (Eigen::Index k = 0; k < then.covered.size(); ++k) {
      if (!(then.covered[k] > 0)) continue;  // of nobody who takes
      auto& shares = shares_[faces.place_of(other.face, now, k)];
      auto found = std::ranges::find_if(shares, [&](const Share& share) { return same(share.axis, other.axis); });
      if (found == shares.end()) found = shares.insert(shares.end(), {other.axis, {}});
      const auto add = [&](Local node, bool on_primary, double value) {
        if (value != 0) found->terms.push_back({node, on_primary, value});
      };
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        const auto column = static_cast<Eigen::Index>(j);
        add(nodes[j], false, then.mass(k, column) - now.mass(k, column));
      }
      for (std::size_t j = 0; j < now.nodes.size(); ++j) {
        const auto column = static_cast<Eigen::Index>(j);
        add(now.nodes[j], true, then.opposite(k, column) - now.opposite(k, column));
      }
    }
  }
  for (auto& [place, shares] : shares_)
    for (auto& share : shares) merge_terms(share.terms);
}

std::vector<RowWriter::Couple> SharesBesideSupports::to(std::size_t place, double d, const Point& direction)
{
  constexpr double nothing = 1e-9;
  std::vector<RowWriter::Couple> result;
  const auto found = shares_.find(place);
  if (found == shares_.end()) return result;
  handed_.clear();
  handed_.reserve(found->second.size());
  for (const auto& [axis, terms] : found->second) {
    const double part = direction.dot(axis);
    if (std::abs(part) < nothing) continue;
    auto& mine = handed_.emplace_back(terms);
    for (auto& term : mine) term.value *= part / d;
    result.push_back({mine, axis});
  }
  return result;
}

}  // namespace mortise::contact
