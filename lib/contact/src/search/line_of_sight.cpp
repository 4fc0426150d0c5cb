#include "search/line_of_sight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace mortise::contact {

namespace {

// Of the distance: nearer to its ends are the faces there.
constexpr double at_ends = 0.01;
// Of the distance: ends that are so near to the plane of a face along which the line runs lie in it.
constexpr double in_plane = 1e-3;
// Of an overlap's depth: what is as deep is no less.
constexpr double shorter = 1 - 1e-6;
// Of the size of a face: what is nearer is seen.
constexpr double thin = 0.01;

// Whether the line from x along a unit vector passes through a facet before it ends, on which side it comes from or goes on.
// Those along which it runs all but flat, as it leaves a body next to its rim, are met where it passes their plane.
bool passes(const Point& x, const Point& along, double length, const FaceGeometry& facet)
{
  const Point normal = facet.normal();
  const double cosine = normal.dot(along);
  if (std::abs(cosine) < -opposed) {
    const double above = (x - facet.centre()).dot(normal), beyond = above + length * cosine;
    if (above * beyond >= 0 || std::min(std::abs(above), std::abs(beyond)) < in_plane * length) return false;
    const double part = above / (above - beyond);
    return part > at_ends && part < 1 - at_ends && shoot(x + part * length * along, -normal, facet).found;
  }
  const double towards = cosine < 0 ? 1 : -1;
  const Hit hit = shoot(x, towards * along, facet);
  const double distance = towards * hit.distance;
  return hit.found && distance > at_ends * length && distance < (1 - at_ends) * length;
}

bool crosses(const Side& side, const Tree& tree, const Point& x, const Point& way)
{
  Box box(x, x);
  box.extend(x + way);
  const double length = way.norm();
  const Point along = way / length;
  return std::ranges::any_of(tree.candidates(box),
                             [&](int f) { return passes(x, along, length, side.geometry(static_cast<std::size_t>(f))); });
}

// How far a place is from the plane of a facet; none if it lies neither before nor behind it.
std::optional<double> height_over(const Point& x, const FaceGeometry& facet)
{
  const Hit hit = shoot(x, -facet.normal(), facet);
  return hit.found ? std::optional(std::abs(hit.distance)) : std::nullopt;
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
  const Point way = gap * direction;
  return crosses(secondary_, secondary_tree_, x, way) || crosses(primary_, primary_tree_, x, way) ||
         (gap < 0 && overlaps_less_across(x, way));
}

// Facets along which the line runs, opposite each other, enclose its middle.
bool LineOfSight::overlaps_less_across(const Point& x, const Point& way) const
{
  const double length = way.norm();
  const Point middle = x + 0.5 * way, along = way / length, room = Point::Constant(length);
  const Box box(middle - room, middle + room);
  struct Facet {
    Point normal;
    double height;
  };
  const auto each_along = [&](const Side& side, const Tree& tree, const auto& use) {
    return std::ranges::any_of(tree.candidates(box), [&](int f) {
      const auto facet = side.geometry(static_cast<std::size_t>(f));
      const Point normal = facet.normal();
      if (std::abs(normal.dot(along)) >= -opposed) return false;
      const auto height = height_over(middle, facet);
      return height && *height < length && use(Facet{normal, *height});
    });
  };
  std::vector<Facet> others;
  each_along(primary_, primary_tree_, [&](const Facet& facet) {
    others.push_back(facet);
    return false;
  });
  return !others.empty() && each_along(secondary_, secondary_tree_, [&](const Facet& own) {
    return std::ranges::any_of(others, [&](const Facet& other) {
      return own.normal.dot(other.normal) < opposed && own.height + other.height < shorter * length;
    });
  });
}

}  // namespace mortise::contact
