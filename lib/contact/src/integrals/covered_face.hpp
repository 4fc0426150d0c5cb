// A face of a secondary side in its plane, and what the primary side covers of it.
#pragma once

#include <span>
#include <vector>

#include "integrals/base_corners.hpp"
#include "integrals/covered_basis.hpp"
#include "integrals/overlap.hpp"
#include "integrals/pieces.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

class CoveredFace {
 public:
  /// Of faces of `secondary`, which must outlive it. `corners`: functions may stand at corners of the common base.
  CoveredFace(const Side& secondary, const Side& primary, bool corners);

  /// Whether functions stand at corners of the base.
  bool has_corners() const { return !sharp_.empty(); }
  /// The next face, of which nothing is covered so far.
  void lay_flat(std::size_t face);
  /// As long as no face is laid flat nothing is noted.
  void forget() { nodes_.clear(); }
  bool laid_flat() const { return !nodes_.empty(); }
  /// What a facet of it has in common with a primary one.
  void note(std::size_t facet, std::size_t other, const Overlap& common);
  /// Once all are noted: which corners of the base are those of the covered part.
  void find_corners();

  /// The place in the plane where the shape functions of a facet are `shape`.
  Plane in_face(std::size_t facet, const Eigen::Vector4d& shape) const;
  /// How far its nodes are from what is covered, at most, in lengths of the face.
  double farthest_node() const;
  /// Whether no corner of the face is covered.
  bool inside() const;
  /// The part of the convex hull of what is covered that lies between the points of the functions of its `pieces`, those of a
  /// node in all of them taken together.
  double reached(std::span<const PieceIntegrals> pieces) const;
  /// Whether each corner is the point of a function.
  bool reach_corners(std::span<const PieceIntegrals> pieces) const;
  /// Says of the functions that belong to corners to which.
  void name_corners(std::span<PieceIntegrals> pieces) const;

  /// Functions of all that is covered, and their places in `piece`, which has room for them.
  CoveredBasis basis() const { return {secondary_.faces.type[face_], nodes_, parts_, samples_, corners_}; }
  void put_points(const CoveredBasis& basis, PieceIntegrals& piece) const;

 private:
  void note_crossings(std::size_t facet, std::size_t other, const Overlap& common, const Locator& locator);
  bool at_corner(const BaseCorner& corner, const PieceIntegrals& piece, Eigen::Index k) const;
  Few<Plane, 4> corners_of(std::size_t facet) const;
  double length() const { return (nodes_[1] - nodes_[0]).norm(); }

  const Side &secondary_, &primary_;
  std::vector<char> sharp_;  // nodes of the primary side
  std::vector<std::array<bool, 4>> border_, other_border_;
  Local next_number_ = 0;  // of a crossing
  std::size_t face_ = 0;
  Few<Plane, 9> nodes_;  // in the plane
  std::vector<CoveredPart> parts_;
  std::vector<Sample> samples_;
  std::vector<BaseCorner> corners_;  // while parts are noted all sharp nodes and crossings, then those of the covered part
};

}  // namespace mortise::contact
