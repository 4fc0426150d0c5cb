#include "rows/supported_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

bool by_dof(const constraint::PrescribedDof& a, const constraint::PrescribedDof& b)
{
  return std::tie(a.node, a.component) < std::tie(b.node, b.component);
}

}  // namespace

SupportDirectory::SupportDirectory(std::span<const constraint::PrescribedDof> prescribed,
                                   std::span<const constraint::SkewSupport> skew_supports, const Communicator& comm)
    : prescribed_(by_node(prescribed, comm)), skew_supports_(by_node(skew_supports, comm))
{
}

SupportedNodes::SupportedNodes(const SupportDirectory& directory, const std::vector<Global>& nodes, const Communicator& comm)
{
  if (!comm.any(!directory.prescribed_.empty() || !directory.skew_supports_.empty())) return;
  const auto asked = ask(nodes, comm);
  prescribed_ = answer(directory.prescribed_, asked, comm);
  skew_supports_ = answer(directory.skew_supports_, asked, comm);
  std::sort(prescribed_.begin(), prescribed_.end(), by_dof);
}

const constraint::PrescribedDof* SupportedNodes::find(Global node, int component) const
{
  const constraint::PrescribedDof wanted{node, component, 0, 0, {}};
  const auto found = std::lower_bound(prescribed_.begin(), prescribed_.end(), wanted, by_dof);
  return found != prescribed_.end() && found->node == node && found->component == component ? &*found : nullptr;
}

std::span<const constraint::SkewSupport> SupportedNodes::skew_supports(Global node) const
{
  if (skew_supports_.empty()) return {};
  const auto begin = std::lower_bound(skew_supports_.begin(), skew_supports_.end(), node,
                                      [](const constraint::SkewSupport& i, Global wanted) { return i.node < wanted; });
  const auto end = std::find_if(begin, skew_supports_.end(), [&](const auto& i) { return i.node != node; });
  return {begin, end};
}

bool SupportedNodes::holds(Global node, const Point& direction, int dimension) const
{
  constexpr double none = 1e-6;
  for (int c = 0; c < dimension; ++c)
    if (std::abs(direction[c]) > none && find(node, c)) return true;
  const auto skew = skew_supports(node);
  return std::any_of(skew.begin(), skew.end(), [&](const auto& i) { return std::abs(direction.dot(along(i))) > none; });
}

double SupportedNodes::freedom(Global node, const Point& direction, int dimension) const
{
  Point free = direction;
  for (const auto& i : skew_supports(node)) free -= free.dot(along(i)) * along(i);
  for (int c = 0; c < dimension; ++c)
    if (find(node, c)) free[c] = 0;
  return free.norm();
}

Eigen::Matrix3d SupportedNodes::free_part(Global node, int dimension) const
{
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  for (const auto& i : skew_supports(node)) result -= along(i) * along(i).transpose();
  for (int c = 0; c < 3; ++c)
    if (c >= dimension || find(node, c)) result.row(c).setZero(), result.col(c).setZero();
  return result;
}

Point along(const constraint::SkewSupport& skew_supports)
{
  return {skew_supports.direction[0], skew_supports.direction[1], skew_supports.direction[2]};
}

Directions directions(const Point& normal, const std::array<bool, 3>& prescribed,
                      std::span<const constraint::SkewSupport> skew_supports, int dimension)
{
  Directions result;
  Point free_part = normal;
  for (const auto& i : skew_supports) free_part -= free_part.dot(along(i)) * along(i);
  std::vector<int> free;
  for (int c = 0; c < dimension; ++c) {
    if (prescribed[static_cast<std::size_t>(c)])
      free_part[c] = 0;
    else
      free.push_back(c);
  }
  if (free_part.norm() < hardly_moves) {
    result.free_normal = false;
    return result;
  }
  if (!skew_supports.empty()) {  // orthogonal to each other and to the prescribed components
    if (dimension == 3 && skew_supports.size() == 1 && free.size() == 3)
      result.tangents.push_back(free_part.cross(along(skew_supports[0])).normalized());
  } else if (dimension == 2) {
    if (free.size() == 2) result.tangents.emplace_back(-normal[1], normal[0], 0);
  } else if (free.size() == 3) {
    Eigen::Index axis = 0;  // the axis that is most nearly tangential, the first of equals
    for (int c = 1; c < 3; ++c)
      if (std::abs(normal[c]) < std::abs(normal[axis]) - 1e-8) axis = c;
    const Point first = (Point::Unit(axis) - normal[axis] * normal).normalized();
    result.tangents = {first, normal.cross(first)};
  } else if (free.size() == 2) {  // the free direction in the tangent plane
    Point t = Point::Zero();
    t[free[0]] = -free_part[free[1]];
    t[free[1]] = free_part[free[0]];
    result.tangents.push_back(t.normalized());
  }
  return result;
}

std::vector<Point> other_tangents(const Point& normal, std::span<const Point> tangents, int dimension)
{
  if (tangents.size() + 1 >= static_cast<std::size_t>(dimension)) return {};
  if (tangents.size() == 1) return {normal.cross(tangents[0]).normalized()};
  return directions(normal, {false, false, false}, {}, dimension).tangents;
}

}  // namespace mortise::contact
