#include "integrals/face_integrals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "rows/one_part.hpp"
#include "search/nearest_points.hpp"
#include "surface/facets_round.hpp"

namespace mortise::contact {

namespace {

// A face of second order keeps its own basis if none of its nodes is farther than this part of its length from what is covered:
// projections of curved sides leave such slits at planes of symmetry, those of flat ones leave none but for rounding of
// coordinates. The area says little: that of a corner which stands over is the square of how far it does.
constexpr double curved_slit = 0.02;
// A face whose functions, facet by facet, reach less than this part of what is covered gets points for all of it.
constexpr double least_reach = 0.75;

// Integrals of the shape functions of a triangle or a quadrilateral, projected along its normal.
Eigen::Vector4d whole_of(const FaceGeometry& face)
{
  if (face.type == mesh::CellType::tri3) return face.area() / 3 * Eigen::Vector4d(1, 1, 1, 0);
  // The Jacobian of the map from [-1, 1]^2 is linear, a + b s + c t, and so integral N_i J = a + (b s_i + c t_i) / 3.
  const auto& x = face.nodes;
  const Point normal = face.normal();
  const auto parts = [&](const Point& u, const Point& v) { return u.cross(v).dot(normal); };
  const Point along = 0.25 * (x[1] + x[2] - x[0] - x[3]), up = 0.25 * (x[2] + x[3] - x[0] - x[1]);
  const Point twist = 0.25 * (x[0] - x[1] + x[2] - x[3]);
  const double a = parts(along, up), b = parts(along, twist) / 3, c = parts(twist, up) / 3;
  return {a - b - c, a + b - c, a + b + c, a - b + c};
}

}  // namespace

Integrator::Integrator(const Side& secondary, const SurfaceNodes& secondary_nodes, const Side& primary,
                       const SurfaceNodes& primary_nodes, const Tree& tree, const LineOfSight& sight, double reach, bool corners,
                       const std::vector<NearestPoint>& nearest, std::span<const std::vector<Local>> bonded)
    : secondary_(secondary),
      secondary_nodes_(secondary_nodes),
      primary_(primary),
      primary_nodes_(primary_nodes),
      common_parts_(secondary, primary, tree, sight, reach),
      nearest_(nearest),
      slot_(primary.points.size(), -1),
      covered_face_(secondary, primary, corners),
      bonded_(bonded)
{
}

// A face of one piece, so far.
void Integrator::begin(std::size_t face)
{
  forget_nodes();
  pieces_.clear();
  start(face, -1);
}

void Integrator::forget_nodes()
{
  if (pieces_.empty()) return;
  for (const Local node : piece_->nodes) slot_[static_cast<std::size_t>(node)] = -1;
}

// The next piece, with nothing in it. `functions`: how many, if that is not what follows from the facet.
void Integrator::start(std::size_t face, Local facet, std::size_t functions)
{
  forget_nodes();
  pieces_.emplace_back();
  piece_ = &pieces_.back();
  const auto n = static_cast<Eigen::Index>(secondary_.faces[face].size());
  const auto r = functions > 0 ? static_cast<Eigen::Index>(functions)
                 : facet < 0   ? n
                               : static_cast<Eigen::Index>(secondary_.facets[static_cast<std::size_t>(facet)].size());
  piece_->facet = facet;
  piece_->mass.setZero(r, n);
  piece_->gram.setZero(r, r);
  if (facet >= 0) piece_->point_facet.assign(static_cast<std::size_t>(r), facet);
  piece_->points.setIdentity(r, 4);
  piece_->plane.resize(0, 2);
  piece_->covered.setZero(r);
  piece_->whole.setZero(r);
  piece_->rise.setZero(r);
}

// Calls add(weight, point, shape functions of the face) at the integration points of a whole facet.
template <class Add>
void Integrator::over_facet(std::size_t facet, const Add& add)
{
  const FaceGeometry geometry = secondary_.geometry(facet);
  FaceGeometry mirror = geometry;
  std::reverse(mirror.nodes.begin(), mirror.nodes.end());
  overlap(geometry, mirror, geometry.size(), secondary_.second_order(static_cast<std::size_t>(secondary_.face_of[facet])),
          overlap_);
  for (const auto& point : overlap_.points)
    add(point.weight * secondary_.thickness(facet, point.secondary), point,
        secondary_.shape_in_face(facet, point.secondary, overlap_.frame, point.at));
}

void Integrator::add_whole(std::size_t facet)
{
  const auto face = static_cast<std::size_t>(secondary_.face_of[facet]);
  const auto type = secondary_.faces.type[face];
  const bool own_basis = piece_->facet >= 0;
  if (secondary_.facets.type[facet] != mesh::CellType::line2 && (own_basis || !secondary_.second_order(face))) {
    piece_->whole += whole_of(secondary_.geometry(facet)).head(piece_->whole.size());
    return;
  }
  FaceShape sum = FaceShape::Zero(piece_->whole.size());
  over_facet(facet, [&](double weight, const OverlapPoint& at, const FaceShape& phi) {
    sum += weight * (own_basis ? FaceShape(at.secondary.head(sum.size())) : phi);
  });
  piece_->whole += own_basis ? sum : FaceShape(multiplier_basis(type) * sum);
}

// Adds the integrals over what two facets have in common: Vector and Matrix have room for the nodes of both faces.
template <class Vector, class Matrix>
void Integrator::add_points(std::size_t facet, std::size_t other, const Bulge& own_bulge, Vector zero, Matrix square, Matrix mass,
                            Matrix across)
{
  const auto face = static_cast<std::size_t>(secondary_.face_of[facet]),
             other_face = static_cast<std::size_t>(primary_.face_of[other]);
  const Bulge other_bulge(primary_, primary_nodes_, other);
  const auto& basis = multiplier_basis(secondary_.faces.type[face]);
  constexpr bool first_order = Vector::SizeAtCompileTime == 4;
  const auto r = piece_->covered.size(), n = piece_->mass.cols();
  const auto nodes = primary_.faces[other_face];
  Vector covered = zero, rise = zero;
  Matrix gram = square;
  for (const auto& point : overlap_.points) {
    const double weight = point.weight * secondary_.thickness(facet, point.secondary);
    const double bulge = own_bulge(point.secondary) + other_bulge(point.primary);
    if constexpr (first_order) {
      const Vector weighted = weight * point.secondary;
      mass.noalias() += weighted * point.secondary.transpose();
      covered += weighted;
      rise += bulge * weighted;
      across.noalias() += weighted * point.primary.transpose();
    } else {
      const FaceShape phi = secondary_.shape_in_face(facet, point.secondary, overlap_.frame, point.at);
      FaceShape theta = phi;
      if (basis_)
        theta = (*basis_)(covered_face_.in_face(facet, point.secondary));
      else if (piece_->facet >= 0)
        theta = point.secondary.head(r);
      else if (secondary_.second_order(face))
        theta.noalias() = basis * phi;
      const FaceShape weighted = weight * theta;
      mass.noalias() += weighted * phi.transpose();
      gram.noalias() += weighted * theta.transpose();
      covered += weighted;
      rise += bulge * weighted;
      across.noalias() += weighted * primary_.shape_in_face(other, point.primary, overlap_.frame, point.at).transpose();
    }
  }
  piece_->mass += mass.topLeftCorner(r, n);
  piece_->gram += (first_order ? mass : gram).topLeftCorner(r, r);
  piece_->covered += covered.head(r);
  piece_->rise += rise.head(r);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    auto& slot = slot_[static_cast<std::size_t>(nodes[k])];
    if (slot < 0) {
      slot = static_cast<Local>(piece_->nodes.size());
      piece_->nodes.push_back(nodes[k]);
      piece_->opposite.emplace_back(FaceShape::Zero(r));
    }
    piece_->opposite[static_cast<std::size_t>(slot)] += across.col(static_cast<Eigen::Index>(k)).head(r);
  }
}

void Integrator::add_pair(std::size_t facet, std::size_t other, const Bulge& own_bulge)
{
  const bool second_order = secondary_.second_order(static_cast<std::size_t>(secondary_.face_of[facet]));
  const auto other_face = static_cast<std::size_t>(primary_.face_of[other]);
  if (piece_->facet >= 0) {
    common_.push_back(overlap_.common);
    if (covered_face_.laid_flat()) covered_face_.note(facet, other, overlap_);
  }
  if (!basis_ && !second_order && !primary_.second_order(other_face)) {
    const Eigen::Matrix4d zero = Eigen::Matrix4d::Zero();
    return add_points<Eigen::Vector4d, Eigen::Matrix4d>(facet, other, own_bulge, Eigen::Vector4d::Zero(), zero, zero, zero);
  }
  const auto r = piece_->covered.size(), n = piece_->mass.cols();
  const auto m = static_cast<Eigen::Index>(primary_.faces[other_face].size());
  add_points<FaceShape, SmallMatrix>(facet, other, own_bulge, FaceShape::Zero(r), SmallMatrix::Zero(r, r),
                                     SmallMatrix::Zero(r, n), SmallMatrix::Zero(r, m));
}

// Adds all that a facet looks at to the piece at work.
void Integrator::integrate_facet(std::size_t facet)
{
  add_whole(facet);
  const Bulge own_bulge(secondary_, secondary_nodes_, facet);
  common_parts_.each(facet, false, overlap_, [&](std::size_t other) { add_pair(facet, other, own_bulge); });
}

// All of a face in one piece.
void Integrator::integrate_face(std::size_t face)
{
  begin(face);
  const auto first = static_cast<std::size_t>(secondary_.first_facet[face]),
             end = static_cast<std::size_t>(secondary_.first_facet[face + 1]);
  for (std::size_t facet = first; facet < end; ++facet) integrate_facet(facet);
}

Cover Integrator::cover(std::size_t face)
{
  integrate_face(face);
  if (piece_->nodes.empty()) return {};
  if (body_of_.empty()) body_of_ = connected_parts(primary_, bonded_);
  const auto body = [&](Local node) { return body_of_[static_cast<std::size_t>(node)]; };
  const Local first = body(piece_->nodes[0]);
  const bool one = std::ranges::all_of(piece_->nodes, [&](Local node) { return body(node) == first; });
  return {piece_->covered.sum() / piece_->whole.sum(), one ? first : -1};
}

std::span<const PieceIntegrals> Integrator::integrate(std::size_t face, bool in_facets)
{
  integrate_face(face);
  in_facets = in_facets || moved(face);
  const double covered = piece_->covered.sum(), whole = piece_->whole.sum();
  if (covered > 0 && covered < (1 - 1e-6) * whole) {
    cut(face, in_facets);
  } else if (covered > 0 && in_facets) {
    covered_face_.forget();
    cut_into_facets(face);
  }
  return pieces_;
}

// Into its facets, unless what is covered lies inside the face, or too little of it between the points of the face's functions
// then: a facet that is covered in its middle has too few of them, and where facets meet they mean different points. Or one of
// its corners is none of these points. A face of which only slits are missing stays what it was.
void Integrator::cut(std::size_t face, bool in_facets)
{
  const bool in_space = mesh::corner_count(secondary_.faces.type[face]) > 2, high = secondary_.second_order(face);
  covered_face_.forget();
  if (in_space && (high || covered_face_.has_corners())) covered_face_.lay_flat(face);
  PieceIntegrals one_piece;
  if (high) one_piece = pieces_.front();
  cut_into_facets(face);
  const bool whole = high && (in_space ? covered_face_.farthest_node() <= slits(face)
                                       : one_piece.covered.sum() >= (1 - slits(face)) * one_piece.whole.sum());
  if (whole && !in_facets) {
    forget_nodes();
    pieces_.assign(1, one_piece);
    piece_ = &pieces_.back();
  }
  if (whole || !covered_face_.laid_flat()) return;
  covered_face_.find_corners();
  if ((high && (covered_face_.inside() || covered_face_.reached(pieces_) < least_reach)) || !covered_face_.reach_corners(pieces_))
    move_points(face);
  covered_face_.name_corners(pieces_);
}

// How far a node of a face may be from what is covered, in its lengths, for no more than slits to be missing.
double Integrator::slits(std::size_t face) const
{
  double curved = 0;  // the angle between normals
  for (auto facet = static_cast<std::size_t>(secondary_.first_facet[face]);
       facet < static_cast<std::size_t>(secondary_.first_facet[face + 1]); ++facet) {
    const Point normal = secondary_.geometry(facet).normal();
    for (std::size_t c = 0; c < secondary_.facets[facet].size(); ++c)
      curved = std::max(curved, (secondary_nodes_.normal(secondary_, facet, c) - normal).norm());
  }
  return std::clamp(curved, slit, curved_slit);
}

// A face that stays one piece, with functions that belong to points of its covered part.
void Integrator::move_points(std::size_t face)
{
  basis_.emplace(covered_face_.basis());
  forget_nodes();
  pieces_.clear();
  start(face, -1, basis_->size());
  covered_face_.put_points(*basis_, *piece_);
  for (auto facet = static_cast<std::size_t>(secondary_.first_facet[face]);
       facet < static_cast<std::size_t>(secondary_.first_facet[face + 1]); ++facet) {
    const auto& nodes = secondary_.corners[facet];
    const Eigen::Vector4d whole = whole_of(secondary_.geometry(facet));
    for (std::size_t c = 0; c < secondary_.facets[facet].size(); ++c)
      piece_->whole[nodes[c]] += whole[static_cast<Eigen::Index>(c)];
    const Bulge own_bulge(secondary_, secondary_nodes_, facet);
    // Functions of points of its own are linear on triangles, which may be small.
    common_parts_.each(facet, true, overlap_, [&](std::size_t other) { add_pair(facet, other, own_bulge); });
  }
  basis_.reset();
}

void Integrator::cut_into_facets(std::size_t face)
{
  for (auto facet = secondary_.first_facet[face]; facet < secondary_.first_facet[face + 1]; ++facet) {
    start(face, facet);
    common_.clear();
    const auto at = static_cast<std::size_t>(facet);
    integrate_facet(at);
    if (common_.empty()) continue;
    const FaceGeometry own = secondary_.geometry(at);
    Few<Plane, 4> nodes;
    for (const auto& p : own.nodes) nodes.push_back(overlap_.frame.project(p));
    move_into(common_, own.type, nodes, points_of(at), *piece_);
  }
  pieces_.erase(pieces_.begin());
  piece_ = &pieces_.back();
}

bool Integrator::moved(std::size_t face) const
{
  if (nearest_.empty()) return false;
  const auto begin = static_cast<std::size_t>(secondary_.faces.offset[face]), end = begin + secondary_.faces[face].size();
  for (std::size_t k = begin; k < end; ++k)
    if (nearest_[static_cast<std::size_t>(secondary_nodes_.of_node[k])].moved()) return true;
  return false;
}

// The shape functions of a facet at the points of its nodes' multipliers, in rows.
SmallMatrix Integrator::points_of(std::size_t facet) const
{
  const std::size_t count = secondary_.facets[facet].size();
  const auto r = static_cast<Eigen::Index>(count);
  SmallMatrix points = SmallMatrix::Identity(r, r);
  if (nearest_.empty()) return points;
  for (std::size_t k = 0; k < count; ++k) {
    const auto p = secondary_nodes_.of_corner[static_cast<std::size_t>(secondary_.facets.offset[facet]) + k];
    const auto& nearest = nearest_[static_cast<std::size_t>(p)];
    if (nearest.moved())
      points.row(static_cast<Eigen::Index>(k)) = shape_beside(secondary_, facet, k, nearest.shift).head(r).transpose();
  }
  return points;
}

std::span<const PieceIntegrals> Integrator::integrate_whole(std::size_t face, bool in_facets)
{
  begin(face);
  in_facets = in_facets || moved(face);
  const auto& basis = multiplier_basis(secondary_.faces.type[face]);
  for (auto facet = secondary_.first_facet[face]; facet < secondary_.first_facet[face + 1]; ++facet) {
    if (in_facets) start(face, facet);
    over_facet(static_cast<std::size_t>(facet), [&](double weight, const OverlapPoint& point, const FaceShape& phi) {
      const FaceShape theta = in_facets ? FaceShape(point.secondary.head(piece_->covered.size())) : FaceShape(basis * phi);
      piece_->mass += weight * theta * phi.transpose();
      piece_->gram += weight * theta * theta.transpose();
      piece_->covered += weight * theta;
    });
    piece_->whole = piece_->covered;
    if (in_facets) move_to(points_of(static_cast<std::size_t>(facet)), of_rounding, *piece_);
  }
  if (in_facets) pieces_.erase(pieces_.begin());
  piece_ = &pieces_.back();
  return pieces_;
}

}  // namespace mortise::contact
