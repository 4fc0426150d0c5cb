// What the facets of the secondary side have in common with those of the primary side.
#pragma once

#include <vector>

#include "integrals/overlap.hpp"
#include "search/line_of_sight.hpp"
#include "search/tree.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

class CommonParts {
 public:
  /// All of which must outlive it; `tree` has the facets of the primary side. What lies farther away than `reach` does not count.
  CommonParts(const Side& secondary, const Side& primary, const Tree& tree, const LineOfSight& sight, double reach)
      : secondary_(secondary), primary_(primary), tree_(tree), sight_(sight), reach_(reach)
  {
  }

  /// Calls use(primary facet) for all that a facet looks at, with what they have in common in `common`. `high`: the integrands
  /// are of second order, whatever the faces are.
  template <class Use>
  void each(std::size_t facet, bool high, Overlap& common, const Use& use)
  {
    high = high || secondary_.second_order(static_cast<std::size_t>(secondary_.face_of[facet]));
    const FaceGeometry own = secondary_.geometry(facet);
    Box box;
    for (const auto& p : own.nodes) box.extend(p);
    const Point margin = Point::Constant(1e-6 * own.size());
    box.min() -= margin;
    box.max() += margin;
    tree_.swept(box, reach_ * own.normal(), met_);
    for (const int met : met_) {
      const auto other = static_cast<std::size_t>(met);
      const bool second_order = high || primary_.second_order(static_cast<std::size_t>(primary_.face_of[other]));
      if (!overlap(own, primary_.geometry(other), reach_, second_order, common)) continue;
      if (!sight_.hidden(common.middle, common.frame.normal, common.distance, own.size())) use(other);
    }
  }

 private:
  const Side &secondary_, &primary_;
  const Tree& tree_;
  const LineOfSight& sight_;
  double reach_;
  std::vector<int> met_;
};

}  // namespace mortise::contact
