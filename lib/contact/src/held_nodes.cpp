#include "held_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "by_node.hpp"

namespace mortise::contact {

namespace {

bool before(const constraint::Held& a, const constraint::Held& b)
{
  return std::tie(a.node, a.component) < std::tie(b.node, b.component);
}

}  // namespace

HeldDirectory::HeldDirectory(std::span<const constraint::Held> held, std::span<const constraint::Inclined> inclined,
                             const Communicator& comm)
    : held_(by_node(held, comm)), inclined_(by_node(inclined, comm))
{
}

HeldNodes::HeldNodes(const HeldDirectory& directory, const std::vector<Global>& nodes, const Communicator& comm)
{
  if (!comm.any(!directory.held_.empty() || !directory.inclined_.empty())) return;
  const auto asked = ask(nodes, comm);
  held_ = answer(directory.held_, asked, comm);
  inclined_ = answer(directory.inclined_, asked, comm);
  std::sort(held_.begin(), held_.end(), before);
}

const constraint::Held* HeldNodes::find(Global node, int component) const
{
  const constraint::Held wanted{node, component, 0, 0};
  const auto found = std::lower_bound(held_.begin(), held_.end(), wanted, before);
  return found != held_.end() && found->node == node && found->component == component ? &*found : nullptr;
}

std::span<const constraint::Inclined> HeldNodes::inclined(Global node) const
{
  if (inclined_.empty()) return {};
  const auto begin = std::lower_bound(inclined_.begin(), inclined_.end(), node,
                                      [](const constraint::Inclined& i, Global wanted) { return i.node < wanted; });
  const auto end = std::find_if(begin, inclined_.end(), [&](const auto& i) { return i.node != node; });
  return {begin, end};
}

Point along(const constraint::Inclined& inclined)
{
  return {inclined.direction[0], inclined.direction[1], inclined.direction[2]};
}

Directions directions(const Point& normal, const std::array<bool, 3>& held, std::span<const constraint::Inclined> inclined,
                      int dimension)
{
  Directions result;
  Point free_part = normal;
  for (const auto& i : inclined) free_part -= free_part.dot(along(i)) * along(i);
  std::vector<int> free;
  for (int c = 0; c < dimension; ++c) {
    if (held[static_cast<std::size_t>(c)])
      free_part[c] = 0;
    else
      free.push_back(c);
  }
  if (free_part.norm() < 1e-6) {
    result.free_normal = false;
    return result;
  }
  if (!inclined.empty()) {  // orthogonal to each other and to the held components
    if (dimension == 3 && inclined.size() == 1 && free.size() == 3)
      result.tangents.push_back(free_part.cross(along(inclined[0])).normalized());
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

}  // namespace mortise::contact
