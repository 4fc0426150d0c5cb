// From the terms of a place to rows in mesh numbering: components that supports hold stand in the bounds.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "face_integrals.hpp"
#include "held_nodes.hpp"
#include "mesh/instances.hpp"

namespace mortise::contact {

/// The rows sum_k value_k / d axis . u(node_k) of a contact.
class RowWriter {
 public:
  /// All of which must outlive it. `turn`: the primary side is turned before it meets the secondary one, and so are its
  /// displacements.
  RowWriter(const Side& secondary, const Side& primary, const HeldNodes& held, const HeldNodes& primary_held, int dimension,
            const std::optional<mesh::Motion>& turn)
      : secondary_(secondary), primary_(primary), held_(held), primary_held_(primary_held), dimension_(dimension), turn_(turn)
  {
  }

  /// Whether supports leave anything of the row.
  bool moves(std::span<const Term> terms, double d, const Point& axis);
  /// What supports contribute to the row.
  double held_part(std::span<const Term> terms, double d, const Point& axis);
  /// Appends the row <= bound, without what supports hold.
  void add(std::span<const Term> terms, double d, const Point& axis, double bound, constraint::Contacts& contacts);

 private:
  struct Coefficient {
    Global node;
    int component;
    double value;
    const constraint::Held* held;
  };
  // Of the row, but for what inclined supports hold.
  const std::vector<Coefficient>& coefficients(std::span<const Term> terms, double d, const Point& axis);
  Point axis_of(const Term& term, const Point& axis) const
  {
    return turn_ && term.on_primary ? Point(turn_->rotation.transpose() * axis) : axis;
  }
  Global node_of(const Term& term) const
  {
    return (term.on_primary ? primary_ : secondary_).node_id[static_cast<std::size_t>(term.node)];
  }
  std::span<const constraint::Inclined> inclined_of(const Term& term) const
  {
    return (term.on_primary ? primary_held_ : held_).inclined(node_of(term));
  }
  void merge();

  const Side &secondary_, &primary_;
  const HeldNodes &held_, &primary_held_;
  int dimension_;
  std::optional<mesh::Motion> turn_;
  std::vector<Coefficient> coefficients_;
};

}  // namespace mortise::contact
