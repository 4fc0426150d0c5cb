#include "line_of_sight.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::contact {

namespace {

// Of the distance: nearer to its ends are the faces there.
constexpr double at_ends = 0.01;
// Of the size of a face: what is nearer is seen.
constexpr double thin = 0.01;

bool crosses(const Side& side, const Tree& tree, const Point& x, const Point& way)
{
  Box box(x, x);
  box.extend(x + way);
  const double length = way.norm();
  const Point along = way / length;
  return std::ranges::any_of(tree.candidates(box), [&](int f) {
    const auto facet = side.geometry(static_cast<std::size_t>(f));
    const double towards = facet.normal().dot(along) < 0 ? 1 : -1;
    const Hit hit = shoot(x, towards * along, facet);
    const double distance = towards * hit.distance;
    return hit.found && distance > at_ends * length && distance < (1 - at_ends) * length;
  });
}

}  // namespace

Tree tree_of_facets(const Side& side)
{
  std::vector<Box> boxes(side.facets.size());
  for (std::size_t f = 0; f < boxes.size(); ++f)
    for (const Local n : side.facets[f]) boxes[f].extend(side.points[static_cast<std::size_t>(n)]);
  return Tree(std::move(boxes));
}

bool LineOfSight::hidden(const Point& x, const Point& direction, double gap, double size) const
{
  if (std::abs(gap) < thin * size) return false;
  return crosses(secondary_, secondary_tree_, x, gap * direction) || crosses(primary_, primary_tree_, x, gap * direction);
}

}  // namespace mortise::contact
