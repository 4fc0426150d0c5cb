#include "rows/bond_directions.hpp"

#include "rows/supported_nodes.hpp"

namespace mortise::contact {

namespace {

constexpr double mostly = 0.7;  // of the normal: the rest passes into supports of both sides with what acts along it
constexpr double half = 0.5;    // of a direction

Point without(Point vector, std::span<const Point> directions)
{
  for (const Point& direction : directions) vector -= vector.dot(direction) * direction;
  return vector;
}

// An orthonormal basis of what is orthogonal to orthonormal directions.
Few<Point, 3> complement(std::span<const Point> directions, int dimension)
{
  Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
  if (dimension == 2) rest(2, 2) = 0;
  for (const Point& direction : directions) rest -= direction * direction.transpose();
  const Few<Point, 3> axes{Point::UnitX(), Point::UnitY(), Point::UnitZ()};
  return directions_of_most(rest, axes, half);
}

// Supports hold the secondary side along the normal. Rows are along all that moves: the first along what the normal has of it.
std::optional<BondDirections> beside_prescribed_normal(const Few<Point, 3>& prescribed, const Few<Point, 3>& of_primary,
                                                       const Point& normal, int dimension)
{
  if (of_primary.size() == prescribed.size()) return std::nullopt;
  Few<Point, 3> moving = complement(prescribed, dimension);
  for (const Point& direction : of_primary) moving.push_back(direction);
  if (moving.empty()) return std::nullopt;
  Point first = normal - without(normal, moving);
  BondDirections result{moving[0], {}, {}};
  result.in_surface = first.norm() < hardly_moves;
  if (!result.in_surface) result.normal = first.normalized();
  const Few<Point, 1> taken{result.normal};
  const Few<Point, 3> others = complement(taken, dimension);
  Eigen::Matrix3d part = Eigen::Matrix3d::Zero();
  for (const Point& direction : moving) part += direction * direction.transpose();
  for (const Point& direction : directions_of_most(part, others, half)) result.of_primary.push_back(direction);
  return result;
}

}  // namespace

std::optional<BondDirections> bond_directions(const RowWriter& writer, std::span<const Term> terms, const Point& normal,
                                              std::optional<double> least, int dimension)
{
  const auto prescribed = writer.prescribed_on_secondary(terms);
  if (prescribed.empty()) return std::nullopt;
  const auto of_primary = least ? writer.free_on_primary(terms, prescribed, *least) : Few<Point, 3>();
  const Point left = without(normal, prescribed);
  if (left.norm() < hardly_moves)
    return least ? beside_prescribed_normal(prescribed, of_primary, normal, dimension) : std::nullopt;
  BondDirections result{normal, {}, {}};
  for (const Point& direction : of_primary) result.of_primary.push_back(direction);
  if (!result.of_primary.empty() || left.norm() < mostly) result.normal = left.normalized();
  if (dimension == 3 && prescribed.size() == 1) result.tangents.push_back(prescribed[0].cross(left).normalized());
  return result;
}

}  // namespace mortise::contact
