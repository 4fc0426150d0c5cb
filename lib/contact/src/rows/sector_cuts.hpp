// Whether the cuts of a cyclic sector fit each other.
#pragma once

#include "search/near.hpp"

namespace mortise::contact {

/// How the cuts of a sector lie on each other once rotated, of all ranks: the area in common, and the widest and the mean
/// distance at the nodes that carry multipliers (none: points is 0).
struct CutFit {
  double covered = 0, widest = 0, distances = 0, points = 0;

  /// Of a node, unless it is infinite.
  void note(double distance);
  double mean() const { return points > 0 ? distances / points : 0; }
  bool meet() const { return points > 0; }
};

/// Of the parts on all ranks. Collective.
CutFit over_ranks(const CutFit& part, const Communicator& comm);

/// Bonded cuts are one surface once rotated; sides that do not lie on each other would be tied all the same, and are an error.
/// Throws Error(bad_input). Collective.
void require_one_surface(const Pair& pair, const PairSize& size, const CutFit& fit, const Communicator& comm);

/// Whether cuts that touch lie so far apart that they may be rotated the wrong way. What they have between them never says so by
/// itself: a gap may be meant, and where they do not meet at all, a warning tells.
bool may_be_rotated_wrongly(const Pair& pair, const PairSize& size, const CutFit& fit);

/// The pair with its primary side rotated the other way.
Pair rotated_the_other_way(const Pair& pair);

/// Throws Error(bad_input) if cuts lie on each other rotated the other way alone, or much nearer: real gaps are less than a
/// sector is wide, and the wrong way adds twice its width.
void require_this_way(const Pair& pair, const PairSize& size, const CutFit& fit, const CutFit& other_way);

}  // namespace mortise::contact
