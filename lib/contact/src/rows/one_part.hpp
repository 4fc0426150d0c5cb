// A multiplier that acts at one place pushes on the one body that is there.
#pragma once

#include <span>
#include <vector>

#include "integrals/face_integrals.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

/// Of each node of a side the number of the part that it belongs to: faces that share a node are of one, and so are nodes that
/// are `bonded`.
std::vector<Local> connected_parts(const Side& side, std::span<const std::vector<Local>> bonded);

class OnePart {
 public:
  explicit OnePart(const Side& primary);

  /// If the primary `terms` of a row (merged, sorted by nodes) are not all on faces that hang together with the facet that `met`,
  /// what lies opposite the row's point, is of, the face there gets the sum of all by its shape functions: where a face is as
  /// large as the rollers that touch it, its functions see the next ones, too.
  void take(const Opposite& met, std::vector<Term>& terms) const;

 private:
  // Those of the primary `terms` to which faces with terms at all nodes lead from a face.
  std::vector<char> reached_from(std::size_t face, std::span<const Term> terms) const;

  const Side& primary_;
  std::vector<std::size_t> first_;  // of each node in faces_
  std::vector<Local> faces_;
};

}  // namespace mortise::contact
