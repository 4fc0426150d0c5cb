// What one side sees of the other: not what lies behind faces, as the next tooth of a gear does behind a tooth.
#pragma once

#include "search/tree.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

Tree tree_of_facets(const Side& side);

class LineOfSight {
 public:
  /// `tree` has the facets of the primary side. All of them outlive it.
  LineOfSight(const Side& secondary, const Side& primary, const Tree& tree)
      : secondary_(secondary), primary_(primary), secondary_tree_(tree_of_facets(secondary)), primary_tree_(tree)
  {
  }

  /// Whether a facet of either side lies between x and x + gap direction, or, if gap < 0, the sides overlap by less than -gap
  /// across this line: the head of a bolt that stands in its plate by a little is not as deep in the wall of the hole as its rim
  /// is wide. `size`: of a face; bodies are not as thin as a hundredth of it.
  bool hidden(const Point& x, const Point& direction, double gap, double size) const;

 private:
  bool overlaps_less_across(const Point& x, const Point& way) const;
  const Side &secondary_, &primary_;
  Tree secondary_tree_;
  const Tree& primary_tree_;
};

}  // namespace mortise::contact
