#include "surface/arc_normals.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace mortise::contact {

namespace {

// Of the angle between two facets, the least that tells; and of what is told, the most by which the two sides may differ.
constexpr double tells = 0.1, agree = 0.1;
// Of the jump of the curvature, how much it may change on either side: along a smooth curve that is half of it.
constexpr double constant = 0.25;

// From the origin towards u, along the circle through u and v.
Point tangent(const Point& u, const Point& v)
{
  return (u / u.squaredNorm() - v / v.squaredNorm()).normalized();
}

// Of the circle through three points of the plane, signed.
double curvature(const Point& a, const Point& b, const Point& c)
{
  const Point first = b - a, second = c - b;
  return 2 * first.cross(second)[2] / (first.norm() * second.norm() * (c - a).norm());
}

}  // namespace

void take_normals_between_arcs(const Side& side, SurfaceNodes& surface_nodes)
{
  if (side.facets.size() == 0 || side.facets.type[0] != mesh::CellType::line2) return;
  const auto at = [&](Local p) -> const Point& {
    return side.points[static_cast<std::size_t>(surface_nodes.all[static_cast<std::size_t>(p)].node)];
  };
  std::vector<Few<Local, 2>> beside(surface_nodes.all.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto begin = static_cast<std::size_t>(side.facets.offset[f]);
    const Local a = surface_nodes.of_corner[begin], b = surface_nodes.of_corner[begin + 1];
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
      if (auto& next = beside[static_cast<std::size_t>(from)]; next.size() < 2) next.push_back(to);
  }
  // The surface node beyond `next`, seen from `p`; -1: none.
  const auto beyond = [&](Local p, Local next) {
    for (const Local q : beside[static_cast<std::size_t>(next)])
      if (q != p) return q;
    return Local{-1};
  };
  for (std::size_t n = 0; n < beside.size(); ++n) {
    if (beside[n].size() < 2) continue;
    const auto p = static_cast<Local>(n);
    const Local first = beside[n][0], last = beside[n][1], before = beyond(p, first), after = beyond(p, last);
    if (before < 0 || after < 0) continue;
    const Point a = at(first) - at(p), b = at(last) - at(p);
    const Point back = -tangent(a, at(before) - at(p)), forth = tangent(b, at(after) - at(p)), across = tangent(b, a);
    const Point mean = (back + forth).normalized();
    const double turn = (a.normalized() + b.normalized()).norm(), jump = (across - mean).norm();
    if (!(jump > tells * turn) || !((back - forth).norm() < agree * jump)) continue;
    const double here = curvature(at(before), at(first), at(p)), there = curvature(at(p), at(last), at(after));
    const auto changes = [&](double at_node, Local next, Local last_but_one, Local last_one) {
      return next >= 0 &&
             std::abs(curvature(at(next), at(last_one), at(last_but_one)) - at_node) > constant * std::abs(there - here);
    };
    if (changes(here, beyond(first, before), first, before) || changes(-there, beyond(last, after), last, after)) continue;
    Point& normal = surface_nodes.all[n].normal;
    normal = (normal - normal.dot(mean) * mean).normalized();
  }
}

}  // namespace mortise::contact
