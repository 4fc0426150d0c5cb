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
  bool in_surface = false;  ///< supports of both sides hold the surface's normal: `normal` is orthogonal to it
};

/// Of the node with these terms; none where supports hold nothing of it, where the primary side moves along all that they hold,
/// or where nothing moves. `least`: freedom of the primary side that makes a row, as RowWriter::freedom() has it; none if that
/// does not move, as obstacles. Of a pair of nodes any freedom does; others are means over nodes that supports may not hold.
std::optional<BondDirections> bond_directions(const RowWriter& writer, std::span<const Term> terms, const Point& normal,
                                              std::optional<double> least, int dimension);

}  // namespace mortise::contact
