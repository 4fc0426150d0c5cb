#include "rows/bond_directions.hpp"

#include "rows/supported_nodes.hpp"

namespace mortise::contact {

std::optional<BondDirections> bond_directions(const RowWriter& writer, std::span<const Term> terms, const Point& normal,
                                              bool both_sides, int dimension)
{
  constexpr double mostly = 0.7;  // of the normal: the rest passes into supports of both sides with what acts along it
  constexpr double half = 0.5;    // of the primary side
  const auto prescribed = writer.prescribed_on_secondary(terms);
  Point left = normal;
  for (const Point& direction : prescribed) left -= left.dot(direction) * direction;
  if (prescribed.empty() || left.norm() < hardly_moves) return std::nullopt;
  BondDirections result{normal, {}, {}};
  for (const Point& direction : prescribed)
    if (both_sides && writer.freedom(terms, true, direction) > half) result.of_primary.push_back(direction);
  if (!result.of_primary.empty() || left.norm() < mostly) result.normal = left.normalized();
  if (dimension == 3 && prescribed.size() == 1) result.tangents.push_back(prescribed[0].cross(left).normalized());
  return result;
}

}  // namespace mortise::contact
