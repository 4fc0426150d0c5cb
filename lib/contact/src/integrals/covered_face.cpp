#include "integrals/covered_face.hpp"

#include <algorithm>
#include <limits>

namespace mortise::contact {

CoveredFace::CoveredFace(const Side& secondary, const Side& primary, bool corners) : secondary_(secondary), primary_(primary)
{
  if (!corners) return;
  sharp_ = sharp_nodes(primary);
  border_ = border_edges(secondary);
  other_border_ = border_edges(primary);
  next_number_ = static_cast<Local>(primary.points.size());
}

void CoveredFace::lay_flat(std::size_t face)
{
  face_ = face;
  const auto type = secondary_.faces.type[face];
  const auto point = [&](std::size_t k) { return secondary_.points[static_cast<std::size_t>(secondary_.faces[face][k])]; };
  FaceGeometry corners{mesh::first_order(type), {}};
  for (int k = 0; k < mesh::corner_count(type); ++k) corners.nodes.push_back(point(static_cast<std::size_t>(k)));
  const Frame frame = frame_of(corners);
  nodes_.clear();
  for (std::size_t k = 0; k < secondary_.faces[face].size(); ++k) nodes_.push_back(frame.project(point(k)));
  parts_.clear();
  samples_.clear();
  corners_.clear();
}

void CoveredFace::note(std::size_t facet, std::size_t other, const Overlap& common)
{
  const FaceGeometry own = secondary_.geometry(facet);
  Few<Plane, 4> nodes;
  for (const auto& p : own.nodes) nodes.push_back(common.frame.project(p));
  const Locator locator(own.type, nodes);
  parts_.push_back({static_cast<Local>(facet), {}});
  for (const auto& p : common.common) parts_.back().polygon.push_back(in_face(facet, locator(p)));
  for (const auto& point : common.points) samples_.push_back({in_face(facet, point.secondary), point.weight});
  for (const Local node : primary_.facets[other])
    if (!sharp_.empty() && sharp_[static_cast<std::size_t>(node)]) {
      const Plane at = common.frame.project(primary_.points[static_cast<std::size_t>(node)]);
      corners_.push_back({in_face(facet, locator(at)), static_cast<Local>(facet), node});
    }
  if (!sharp_.empty()) note_crossings(facet, other, common, locator);
}

void CoveredFace::note_crossings(std::size_t facet, std::size_t other, const Overlap& common, const Locator& locator)
{
  const auto own = secondary_.facets[facet], others = primary_.facets[other];
  const auto ends = [&](const Side& side, std::span<const Local> nodes, std::size_t k) {
    const auto at = [&](std::size_t i) {
      return common.frame.project(side.points[static_cast<std::size_t>(nodes[i % nodes.size()])]);
    };
    return std::pair(at(k), at(k + 1));
  };
  for (std::size_t k = 0; k < own.size(); ++k)
    for (std::size_t l = 0; l < others.size() && border_[facet][k]; ++l) {
      if (!other_border_[other][l]) continue;
      const auto [a, b] = ends(secondary_, own, k);
      const auto [c, d] = ends(primary_, others, l);
      if (const auto at = crossing(a, b, c, d)) corners_.push_back({in_face(facet, locator(*at)), static_cast<Local>(facet), -1});
    }
}

void CoveredFace::find_corners()
{
  corners_ = base_corners(nodes_, parts_, corners_);
  for (auto& corner : corners_)
    if (corner.number < 0) corner.number = next_number_++;
  if (corners_.empty() || secondary_.second_order(face_)) return;
  // Triangles at corners may be small: integrate as finely as over faces of second order.
  samples_.clear();
  std::vector<Sample> points;
  for (const auto& part : parts_) {
    sample(part.polygon, {.second_order = true}, points);
    samples_.insert(samples_.end(), points.begin(), points.end());
  }
}

Plane CoveredFace::in_face(std::size_t facet, const Eigen::Vector4d& shape) const
{
  Plane at = Plane::Zero();
  for (std::size_t c = 0; c < secondary_.facets[facet].size(); ++c)
    at += shape[static_cast<Eigen::Index>(c)] * nodes_[static_cast<std::size_t>(secondary_.corners[facet][c])];
  return at;
}

double CoveredFace::farthest_node() const
{
  double farthest = 0;
  for (const auto& node : nodes_) {
    double distance = std::numeric_limits<double>::infinity();
    for (const auto& part : parts_) distance = std::min(distance, (nearest_in(part.polygon, node) - node).norm());
    farthest = std::max(farthest, distance);
  }
  return farthest / length();
}

bool CoveredFace::inside() const
{
  const auto corners = static_cast<std::size_t>(mesh::corner_count(secondary_.faces.type[face_]));
  const double near = 1e-6 * length();
  for (std::size_t k = 0; k < corners; ++k)
    for (const auto& part : parts_)
      if ((nearest_in(part.polygon, nodes_[k]) - nodes_[k]).norm() < near) return false;
  return true;
}

double CoveredFace::reached(std::span<const PieceIntegrals> pieces) const
{
  std::vector<Plane> covered, points(nodes_.size(), Plane::Zero());
  for (const auto& part : parts_) covered.insert(covered.end(), part.polygon.begin(), part.polygon.end());
  std::vector<double> sums(nodes_.size(), 0.0);
  for (const auto& piece : pieces)
    for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
      const auto facet = static_cast<std::size_t>(piece.facet);
      const auto node = static_cast<std::size_t>(secondary_.corners[facet][static_cast<std::size_t>(k)]);
      sums[node] += piece.covered[k];
      points[node] += piece.covered[k] * in_face(facet, piece.points.row(k).transpose());
    }
  std::vector<Plane> used;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (sums[k] > 0) used.push_back(points[k] / sums[k]);
  const auto area = [](const std::vector<Plane>& all) {
    double twice = 0;
    const auto corners = convex_hull(all);
    for (std::size_t i = 0; i < corners.size(); ++i) twice += cross(all[corners[i]], all[corners[(i + 1) % corners.size()]]);
    return 0.5 * twice;
  };
  return area(used) / area(covered);
}

bool CoveredFace::reach_corners(std::span<const PieceIntegrals> pieces) const
{
  return std::all_of(corners_.begin(), corners_.end(), [&](const BaseCorner& corner) {
    return std::any_of(pieces.begin(), pieces.end(), [&](const PieceIntegrals& piece) {
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
        if (at_corner(corner, piece, k)) return true;
      return false;
    });
  });
}

// Whether the point of a piece's function is a corner.
bool CoveredFace::at_corner(const BaseCorner& corner, const PieceIntegrals& piece, Eigen::Index k) const
{
  constexpr double same_place = 1e-6;  // of a face
  const auto facet = piece.point_facet[static_cast<std::size_t>(k)];
  if (facet < 0 || !(piece.covered[k] > 0)) return false;
  const Plane at = in_face(static_cast<std::size_t>(facet), piece.points.row(k).transpose());
  return (at - corner.at).norm() < same_place * length();
}

void CoveredFace::name_corners(std::span<PieceIntegrals> pieces) const
{
  if (corners_.empty()) return;
  Few<Global, 9> id;
  for (const Local n : secondary_.faces[face_]) id.push_back(secondary_.node_id[static_cast<std::size_t>(n)]);
  for (auto& piece : pieces) {
    const auto r = static_cast<std::size_t>(piece.covered.size());
    piece.corner.assign(r, -1);
    piece.beside.assign(r, -1);
    for (std::size_t k = 0; k < r; ++k)
      for (const auto& corner : corners_)
        if (at_corner(corner, piece, static_cast<Eigen::Index>(k))) {
          piece.corner[k] = corner.number;
          piece.beside[k] = static_cast<Local>(node_beside(secondary_.faces.type[face_], nodes_, id, corner.at));
        }
  }
}

Few<Plane, 4> CoveredFace::corners_of(std::size_t facet) const
{
  Few<Plane, 4> nodes;
  for (std::size_t c = 0; c < secondary_.facets[facet].size(); ++c)
    nodes.push_back(nodes_[static_cast<std::size_t>(secondary_.corners[facet][c])]);
  return nodes;
}

void CoveredFace::put_points(const CoveredBasis& basis, PieceIntegrals& piece) const
{
  const auto n = basis.size();
  piece.point_facet.resize(n);
  piece.points.setZero(static_cast<Eigen::Index>(n), 4);
  piece.plane.setZero(static_cast<Eigen::Index>(n), 2);
  for (std::size_t k = 0; k < n; ++k) {
    const Local facet = piece.point_facet[k] = basis.facet(k);
    if (facet < 0) continue;
    const auto at = static_cast<std::size_t>(facet);
    piece.points.row(static_cast<Eigen::Index>(k)) =
        Locator(secondary_.facets.type[at], corners_of(at))(basis.point(k)).transpose();
    piece.plane.row(static_cast<Eigen::Index>(k)) = basis.point(k).transpose();
  }
}

}  // namespace mortise::contact
