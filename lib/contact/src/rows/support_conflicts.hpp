// What supports that hold both sides of a contact push into each other, or tear out of a bond.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "contact/options.hpp"
#include "rows/rows.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

/// How far they do, at most.
struct Conflicts {
  double crossing = 0, tear = 0;

  /// Throws Error(bad_input) if, on any rank, supports alone push the two sides into each other, or those of a bond apart, by
  /// more than rounding of `reach`. Collective.
  void refuse(const Options& options, double reach, const Communicator& comm) const;
};

class SupportConflicts {
 public:
  /// All of which must outlive it. `dimension`: 2 or 3.
  SupportConflicts(const Side& secondary, const Side& primary, RowWriter& writer, int dimension)
      : secondary_(secondary), primary_(primary), writer_(writer), dimension_(dimension)
  {
  }

  /// A surface node where supports prescribe both sides, all or nearly all of the row sum_k value_k / d u(node_k). `stranded`:
  /// its faces have no surface node that supports leave free.
  void note_crossing(std::span<const Term> terms, double d, const Point& normal, double gap, const Directions& directions,
                     bool stranded);
  /// A secondary node of a contact that has no multiplier since supports hold both sides along its normal; `directions`: what is
  /// free there.
  void note_prescribed_crossing(Local node, const Point& normal, const Opposite& opposite, const Directions& directions);
  /// A place of a bond along directions in which supports prescribe both sides.
  void note_tear(std::span<const Term> terms, double d, const Point& normal);
  /// A place of a bond, a secondary node, that has no multiplier since supports hold it: all that they say there of both sides,
  /// if they hold these along a direction.
  void note_prescribed_tear(Local node, const Point& normal, const Opposite& opposite);

  /// Of what has been noted.
  const Conflicts& found() const { return found_; }

 private:
  std::vector<Term> terms_of(Local node, const Opposite& opposite) const;
  double motion(std::span<const Term> terms, double d);
  // What the same smooth motion of both sides may differ by there, since each mesh interpolates it between its own nodes.
  double of_interpolation(std::span<const Term> terms, double d, const Point& direction);
  // The second derivative of what supports prescribe round some nodes of one side; none if too few are held to tell.
  std::optional<double> bend(const std::set<Local>& nodes, bool on_primary, const Point& direction);

  std::set<Local> nodes_round(Local node, bool on_primary);  // of the faces that have it

  const Side &secondary_, &primary_;
  RowWriter& writer_;
  int dimension_;
  std::array<std::vector<std::vector<Local>>, 2> faces_round_;  // of each node of a side, once one is asked
  Conflicts found_;
};

}  // namespace mortise::contact
