// Along which directions a bond has rows at a node where supports hold the secondary side.
#pragma once

#include <optional>
#include <span>

#include "rows/rows.hpp"

namespace mortise::contact {

/// Directions orthogonal to each other, but for the normal where supports hold a little of it on both sides: what is left of the
/// surface's normal, and tangents along which the secondary side moves, or the primary one alone. With a finer secondary side
/// there are more of the latter rows than nodes that they hold, and their multipliers are anybody's guess: those of a row with a
/// part along them would count as pressure.
struct BondDirections {
  Point normal;
  Few<Point, 2> tangents, of_primary;
};

/// Of the node with these terms; none where supports hold nothing of it, or nearly all of its normal. `both_sides`: the primary
/// side moves, as obstacles do not.
std::optional<BondDirections> bond_directions(const RowWriter& writer, std::span<const Term> terms, const Point& normal,
                                              bool both_sides, int dimension);

}  // namespace mortise::contact
