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

// The directions in the surface along which supports hold a surface node.
Few<Point, 3> prescribed_at(const SurfaceNode& node, Global id, const SupportedNodes& supports, int dimension)
{
  Few<Point, 3> result;
  const auto take = [&](const Point& axis) {
    if (result.size() < 3 && std::abs(axis.dot(node.normal)) < in_surface) result.push_back(axis);
  };
  for (int c = 0; c < dimension; ++c)
    if (supports.find(id, c)) take(Point::Unit(c));
  for (const auto& skew : supports.skew_supports(id)) take(along(skew));
  return result;
}

template <class Keep>
void leave_those(Few<Point, 3>& axes, const Keep& keep)
{
  Few<Point, 3> rest;
  for (const Point& axis : axes)
    if (keep(axis)) rest.push_back(axis);
  axes = rest;
}

// The part of what lies opposite a function of a piece that supports leave free along a direction, at the least.
double part_that_moves(const PieceStore::View& piece, const Point& axis, const SharesBesideSupports::OnPrimary& on_primary)
{
  double least = 1;
  for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
    double free = 0, all = 0;
    for (std::size_t j = 0; j < piece.nodes.size(); ++j) {
      const double part = piece.opposite(k, static_cast<Eigen::Index>(j));
      all += part;
      if (!on_primary.at_node(piece.nodes[j], axis)) free += part;
    }
    if (all > 0) least = std::min(least, free / all);
  }
  return least;
}

}  // namespace

SharesBesideSupports::SharesBesideSupports(const Side& secondary, const SurfaceNodes& nodes, CutFaces& faces,
                                           const SupportedNodes& supports, std::span<const char> kept,
                                           const OnPrimary& on_primary, int dimension)
    : secondary_(&secondary), given_(nodes.all.size())
{
  if (supports.empty()) return;
  find_given(nodes, faces, supports, on_primary, dimension);
  find_strays(faces, kept, on_primary);
  for (const std::size_t f : faces.near())
    for (const Point& axis : axes_of(f, faces))
      for (const std::size_t i : faces.pieces(f)) {
        const auto piece = faces.piece(i);
        if (!(piece.covered.sum() > 0)) continue;
        other_.add(piece);
        auto copy = other_[other_.size() - 1];
        make_dual(copy, takers(f, piece, axis, kept, faces));
        others_.push_back({f, i, other_.size() - 1, axis});
      }
}

// The axes along which supports hold both sides wherever functions of a node stand: at the node, or, on faces that the primary
// side's border cuts, at a point inside.
void SharesBesideSupports::find_given(const SurfaceNodes& nodes, CutFaces& faces, const SupportedNodes& supports,
                                      const OnPrimary& on_primary, int dimension)
{
  const auto id_of = [&](Local node) { return secondary_->node_id[static_cast<std::size_t>(node)]; };
  std::vector<Axes> at_nodes(nodes.all.size());
  for (std::size_t p = 0; p < given_.size(); ++p) {
    at_nodes[p] = given_[p] = prescribed_at(nodes.all[p], id_of(nodes.all[p].node), supports, dimension);
    leave_those(at_nodes[p], [&](const Point& axis) { return on_primary.opposite(p, axis); });
  }
  const auto at_point = [&](std::size_t p, const PieceStore::View& piece, Eigen::Index k, const Point& axis) {
    constexpr double rounding = 1e-9;
    const auto corners = secondary_->facets[static_cast<std::size_t>(piece.point_facet[static_cast<std::size_t>(k)])];
    Point at = Point::Zero();
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const double shape = piece.points(k, static_cast<Eigen::Index>(c));
      if (std::abs(shape) > rounding && !supports.holds(id_of(corners[c]), axis, dimension)) return false;
      at += shape * secondary_->points[static_cast<std::size_t>(corners[c])];
    }
    return on_primary.opposite_at(p, at, axis);
  };
  std::vector<char> has_functions(given_.size(), 0);
  for (const std::size_t f : faces.round())
    for (const std::size_t i : faces.pieces(f)) {
      const auto piece = faces.piece(i);
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
        const auto p = faces.surface_node_of(f, piece, k);
        if (!(piece.covered[k] > 0)) continue;
        has_functions[p] = 1;
        if (piece.point_facet.empty() || piece.point_facet[static_cast<std::size_t>(k)] < 0)
          leave_those(given_[p], [&](const Point& axis) {
            return std::ranges::any_of(at_nodes[p], [&](const Point& held) { return same(axis, held); });
          });
        else
          leave_those(given_[p], [&](const Point& axis) { return at_point(p, piece, k, axis); });
      }
    }
  for (std::size_t p = 0; p < given_.size(); ++p)
    if (!has_functions[p]) given_[p] = {};
}

// Of the functions of a piece, whether their places take over along an axis.
Few<char, most_functions> SharesBesideSupports::takers(std::size_t face, const PieceStore::View& piece, const Point& axis,
                                                       std::span<const char> kept, const CutFaces& faces) const
{
  Few<char, most_functions> result;
  for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
    const std::size_t place = faces.place_of(face, piece, k);
    result.push_back(piece.covered[k] > 0 && kept[place] && !gives(faces.surface_node(place), axis));
  }
  return result;
}

// Nodes of the faces beside one, of those that have most nodes in common with it.
std::vector<std::size_t> SharesBesideSupports::takers_beside(std::size_t face, const Point& axis, std::span<const char> kept,
                                                             const CutFaces& faces) const
{
  const auto own = faces.surface_nodes_of(face);
  std::vector<std::size_t> result;
  std::ptrdiff_t most = 1;
  for (const std::size_t f : faces.round()) {
    const auto nodes = faces.surface_nodes_of(f);
    const auto common = std::ranges::count_if(nodes, [&](Local p) { return std::ranges::find(own, p) != own.end(); });
    if (f == face || common < most) continue;
    for (const Local p : nodes) {
      if (!kept[static_cast<std::size_t>(p)] || gives(static_cast<std::size_t>(p), axis)) continue;
      if (common > most) result.clear();
      most = common;
      result.push_back(static_cast<std::size_t>(p));
    }
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Of pieces that have nobody to take over along an axis. A node that keeps its share there keeps as well what it has elsewhere.
void SharesBesideSupports::find_strays(CutFaces& faces, std::span<const char> kept, const OnPrimary& on_primary)
{
  constexpr double half = 0.5;  // of what lies opposite, see ContactRows::freedom_of_primary()
  std::vector<std::pair<std::size_t, Point>> kept_shares;
  const auto nobody = [&](std::size_t f, const PieceStore::View& piece, const Point& axis) {
    return std::ranges::none_of(takers(f, piece, axis, kept, faces), [](char takes) { return takes != 0; });
  };
  // What belongs to other bonds is nobody's here.
  const auto has_rows = [&](std::size_t f, const PieceStore::View& piece) {
    for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
      if (piece.covered[k] > 0 && kept[faces.place_of(f, piece, k)]) return true;
    return false;
  };
  for (const std::size_t f : faces.round())
    for (const Point& axis : axes_of(f, faces))
      for (const std::size_t i : faces.pieces(f)) {
        const auto piece = faces.piece(i);
        if (!(piece.covered.sum() > 0) || !nobody(f, piece, axis)) continue;
        if (has_rows(f, piece) && part_that_moves(piece, axis, on_primary) < half)
          if (auto beside = takers_beside(f, axis, kept, faces); !beside.empty()) {
            strays_.push_back({f, i, axis, std::move(beside), terms_of_constant(f, piece)});
            continue;
          }
        for (const Local p : faces.surface_nodes_of(f)) kept_shares.emplace_back(static_cast<std::size_t>(p), axis);
      }
  for (const auto& [p, axis] : kept_shares) leave_those(given_[p], [&](const Point& given) { return !same(given, axis); });
  std::erase_if(strays_, [&](const Stray& stray) { return !nobody(stray.face, faces.piece(stray.piece), stray.axis); });
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

SharesBesideSupports::Share& SharesBesideSupports::share_of(std::size_t place, const Point& axis)
{
  auto& shares = shares_[place];
  const auto found = std::ranges::find_if(shares, [&](const Share& share) { return same(share.axis, axis); });
  return found != shares.end() ? *found : *shares.insert(shares.end(), {axis, {}});
}

// Of the constant 1 on a piece whose integrals are not yet functions of places.
std::vector<Term> SharesBesideSupports::terms_of_constant(std::size_t face, const PieceStore::View& piece) const
{
  std::vector<Term> result;
  const auto nodes = secondary_->faces[face];
  for (std::size_t j = 0; j < nodes.size(); ++j)
    result.push_back({nodes[j], false, piece.mass.col(static_cast<Eigen::Index>(j)).sum()});
  for (std::size_t j = 0; j < piece.nodes.size(); ++j)
    result.push_back({piece.nodes[j], true, -piece.opposite.col(static_cast<Eigen::Index>(j)).sum()});
  return result;
}

void SharesBesideSupports::take_functions(CutFaces& faces)
{
  for (const auto& other : others_) {
    const auto now = faces.piece(other.piece), then = other_[other.copy];
    const auto nodes = secondary_->faces[other.face];
    for (Eigen::Index k = 0; k < then.covered.size(); ++k) {
      if (!(then.covered[k] > 0)) continue;  // of nobody who takes
      auto& share = share_of(faces.place_of(other.face, now, k), other.axis);
      const auto add = [&](Local node, bool on_primary, double value) {
        if (value != 0) share.terms.push_back({node, on_primary, value});
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
  for (const auto& stray : strays_)
    for (const std::size_t place : stray.takers)
      for (Term term : stray.constant) {
        term.value /= static_cast<double>(stray.takers.size());
        share_of(place, stray.axis).terms.push_back(term);
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
