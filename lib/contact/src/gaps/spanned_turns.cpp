#include "gaps/spanned_turns.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::contact {

namespace {

double angle_between(const Point& a, const Point& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double turn_of(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet)
{
  const Point normal = side.geometry(facet).normal();
  double largest = 0;
  for (std::size_t k = 0; k < side.facets[facet].size(); ++k)
    largest = std::max(largest, 2 * angle_between(normal, surface_nodes.normal(side, facet, k)));
  return largest;
}

// Of the smooth surface of `side` at a place of it.
Point normal_at(const Side& side, const SurfaceNodes& surface_nodes, const Opposite& place)
{
  Point sum = Point::Zero();
  for (std::size_t k = 0; k < side.facets[place.facet].size(); ++k)
    sum += place.hit.shape[static_cast<Eigen::Index>(k)] * surface_nodes.normal(side, place.facet, k);
  return sum;
}

// The angle of an arc tells how far it stands from its chord.
double rise_of(double turn, double chord)
{
  return 0.5 * chord * std::tan(turn / 4);
}

}  // namespace

void note_turns(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary, const SurfaceNodes& primary_nodes,
                Rays& rays, std::span<const char> touches, InitialGap& all)
{
  const auto note = [&](const Side& side, std::size_t facet, double turn) {
    const auto geometry = side.geometry(facet);
    note_turn(all, turn, rise_of(turn, geometry.size()), geometry.centre());
  };
  for (std::size_t facet = 0; facet < secondary.facets.size(); ++facet) {
    const auto at = [&](std::size_t k) {
      return static_cast<std::size_t>(surface_nodes.of_corner[static_cast<std::size_t>(secondary.facets.offset[facet]) + k]);
    };
    const std::size_t corners = secondary.facets[facet].size();
    for (std::size_t k = 0; k < corners; ++k) {
      const Opposite* here = touches[at(k)] ? &rays.meet(at(k)) : nullptr;
      if (here == nullptr || !std::isfinite(here->gap)) continue;
      note(secondary, facet, turn_of(secondary, surface_nodes, facet));
      note(primary, here->facet, turn_of(primary, primary_nodes, here->facet));
      const Opposite& beyond = rays.meet(at((k + 1) % corners));
      if (!touches[at((k + 1) % corners)] || !std::isfinite(beyond.gap)) continue;
      const double own = angle_between(surface_nodes.all[at(k)].normal, surface_nodes.all[at((k + 1) % corners)].normal);
      const double opposite = angle_between(normal_at(primary, primary_nodes, *here), normal_at(primary, primary_nodes, beyond));
      note(secondary, facet, opposite - own);
    }
  }
}

}  // namespace mortise::contact
