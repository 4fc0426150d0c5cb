// From the terms of a surface node to rows in mesh numbering: components that supports hold stand in the bounds.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "integrals/face_integrals.hpp"
#include "mesh/instances.hpp"
#include "rows/supported_nodes.hpp"
#include "search/small.hpp"

namespace mortise::contact {

/// One term a node, summed in the order that they come in.
void merge_terms(std::vector<Term>& terms);

/// Orthonormal directions in the span of the orthonormal `among` of which the symmetric `part` holds more than `least`, ascending
/// in that.
Few<Point, 3> directions_of_most(const Eigen::Matrix3d& part, std::span<const Point> among, double least);

/// The rows sum_k value_k / d axis . u(node_k) of a contact.
class RowWriter {
 public:
  /// All of which must outlive it. `rotation`: the primary side is rotated before it meets the secondary one, and so are its
  /// displacements.
  RowWriter(const Side& secondary, const Side& primary, const SupportedNodes& prescribed, const SupportedNodes& primary_supports,
            int dimension, const std::optional<mesh::Motion>& rotation)
      : secondary_(secondary),
        primary_(primary),
        supports_(prescribed),
        primary_supports_(primary_supports),
        dimension_(dimension),
        rotation_(rotation)
  {
  }

  /// Whether supports leave anything of the row.
  bool moves(std::span<const Term> terms, double d, const Point& axis);
  /// What supports leave of the row, as part of it, in the norms of the coefficients.
  double part_that_moves(std::span<const Term> terms, double d, const Point& axis);
  /// Whether a secondary node is a node of the primary side as well: on the axis of a sector its own image, else, as at the tip
  /// of a slit, a place that nothing opens or closes.
  bool on_both_sides(Local node) const
  {
    return std::ranges::binary_search(primary_.node_id, secondary_.node_id[static_cast<std::size_t>(node)]);
  }
  /// What they leave free of an axis, as part of it: the mean over the nodes of one side, weighted with what the row takes of
  /// them. Nothing at places that nothing opens or closes.
  double freedom(std::span<const Term> terms, bool on_primary, const Point& axis) const;
  /// Of the tangents of `normal` at a secondary node those along which it has a row. A node on the axis of a sector, on both of
  /// its cuts, is its own image: along the axis it goes with itself, and stresses that are alike in all sectors pass nothing on
  /// there; a row along it would feel what the meshes of the cuts differ by alone.
  Few<Point, 2> across_axis(Local node, const Point& normal, std::span<const Point> tangents) const;
  /// Leaves those of the tangents of `normal` (or the one direction between two) along which more than `prescribed_but_for` of
  /// the terms can move, what the row along the normal feels aside. A point near a plane of symmetry that both sides have has a
  /// row across it that is nearly a combination of its others: no friction acts there.
  void leave_what_moves(std::span<const Term> terms, const Point& normal, std::vector<Point>& tangents);
  /// An orthonormal basis of the directions in which supports hold the secondary nodes of the terms, those with
  /// small coefficients aside.
  Few<Point, 3> prescribed_on_secondary(std::span<const Term> terms) const;
  /// Directions in the span of the orthonormal `among` of which supports leave more than `least` on the primary side, as in
  /// freedom().
  Few<Point, 3> free_on_primary(std::span<const Term> terms, std::span<const Point> among, double least) const;
  /// What supports contribute to the row.
  double prescribed_part(std::span<const Term> terms, double d, const Point& axis);
  /// What comes to a row along another axis.
  struct Couple {
    std::span<const Term> terms;
    Point axis;
  };
  /// Appends the row <= bound, without what supports hold, with what comes to it besides.
  void add(std::span<const Term> terms, double d, const Point& axis, double bound, constraint::Contacts& contacts,
           std::span<const Couple> couples = {});
  /// Where supports hold more than a tenth of each side along a tangent, enough to bear what rubs there.
  struct Prescribed {
    Point axis;  ///< along which they bear it: what of the tangent does not move with the normal, a unit vector
    bool moves;  ///< nodes that they hold askew move along the tangent otherwise, so that friction would be lost without a row
  };
  std::optional<Prescribed> prescribed_on_both_sides(std::span<const Term> terms, const Point& normal,
                                                     const Point& tangent) const;
  /// Appends a row along which nothing moves but supports, so that what they make of it stands in its bound, or hardly anything:
  /// nodes that supports leave free leave their part to the others of their side, lest forces are lost. For axes of
  /// prescribed_on_both_sides().
  void add_prescribed(std::span<const Term> terms, double d, const Point& axis, constraint::Contacts& contacts);

 private:
  // Whether the other side has the node as well, and nothing turns it.
  bool one_node(const Term& term) const
  {
    return !rotation_ && std::ranges::binary_search((term.on_primary ? secondary_ : primary_).node_id, node_of(term));
  }
  struct Coefficient {
    Global node;
    int component;
    double value;
    const constraint::PrescribedDof* prescribed;
  };
  static constraint::PrescribedEntry entry_of(std::size_t row, const Coefficient& c);
  // Of the row, but for what skew supports hold.
  const std::vector<Coefficient>& coefficients(std::span<const Term> terms, double d, const Point& axis);
  void append_coefficients(std::span<const Term> terms, double d, const Point& axis);
  // What skew supports hold of the row goes to them and out of its bound.
  void take_skew_supports(std::span<const Term> terms, double d, const Point& axis, double& bound,
                          constraint::Contacts& contacts);
  Point axis_of(const Term& term, const Point& axis) const
  {
    return rotation_ && term.on_primary ? Point(rotation_->rotation.transpose() * axis) : axis;
  }
  Global node_of(const Term& term) const
  {
    return (term.on_primary ? primary_ : secondary_).node_id[static_cast<std::size_t>(term.node)];
  }
  std::span<const constraint::SkewSupport> skew_supports_of(const Term& term) const
  {
    return (term.on_primary ? primary_supports_ : supports_).skew_supports(node_of(term));
  }
  // What moves along an axis at nodes that supports hold askew to it, what the row along the normal feels aside, as part of the
  // row.
  double askew_part(std::span<const Term> terms, const Point& normal, const Point& axis) const;
  // What nodes of one side that supports hold somewhat along an axis move of it, if that is the same for all of them; a point
  // inside a face may see those of several planes.
  std::optional<Point> motion_at_prescribed_nodes(std::span<const Term> terms, bool on_primary, const Point& axis,
                                                  double alike) const;
  // The part of one side at nodes that supports hold somewhat along an axis; 1 of nothing.
  double part_at_prescribed_nodes(std::span<const Term> terms, bool on_primary, const Point& axis) const;
  void merge();
  // Of a term's node: the projector onto what supports leave free, rotated as the node is.
  Eigen::Matrix3d free_part(const Term& term) const;
  // The scalar product of the rows along two directions, over the sum of the squares of the terms; of one side or both.
  Eigen::Matrix3d mobility(std::span<const Term> terms, bool secondary_alone = false) const;

  const Side &secondary_, &primary_;
  const SupportedNodes &supports_, &primary_supports_;
  int dimension_;
  std::optional<mesh::Motion> rotation_;
  std::vector<Coefficient> coefficients_;
};

}  // namespace mortise::contact
