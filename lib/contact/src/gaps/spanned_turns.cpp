#include "gaps/spanned_turns.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "surface/angle.hpp"

namespace mortise::contact {

namespace {

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

// Whether a facet is part of a face of second order that is bent about as much: its nodes say that it is round, and its facets
// stand back from what it is.
bool is_of_bent_face(const Side& side, std::size_t facet, double turn)
{
  constexpr double part = 0.25;
  const auto face = static_cast<std::size_t>(side.face_of[facet]);
  const Point normal = side.geometry(facet).normal();
  for (auto other = static_cast<std::size_t>(side.first_facet[face]);
       other < static_cast<std::size_t>(side.first_facet[face + 1]); ++other)
    if (angle_between(normal, side.geometry(other).normal()) > part * turn) return true;
  return false;
}

// The angle of an arc tells how far it stands from its chord.
double rise_of(double turn, double chord)
{
  return 0.5 * chord * std::tan(turn / 4);
}

}  // namespace

void note_turns(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary, const SurfaceNodes& primary_nodes,
                Rays& rays, InitialGap& all)
{
  constexpr double with_rounding = 1.01;
  constexpr double border = 0.1;     // of a shape function: a place nearer to the border of a facet says little of it
  constexpr double on_a_flat = 0.1;  // of the rise: a face that lies so near on the plane of another one is a flat on a flat
  const auto note = [&](const Side& side, std::size_t facet, double turn) {
    if (is_of_bent_face(side, facet, turn)) return;
    const auto geometry = side.geometry(facet);
    note_turn(all, turn, rise_of(turn, geometry.size()), geometry.centre());
  };
  // Of a facet that is met well inside, if it would touch were it a flat.
  const auto note_opposite = [&](const Opposite& there) {
    const auto corners = static_cast<Eigen::Index>(primary.facets[there.facet].size());
    if (there.hit.shape.head(corners).minCoeff() <= border) return;
    const double turn = turn_of(primary, primary_nodes, there.facet);
    const double rise = rise_of(turn, primary.geometry(there.facet).size());
    if (std::abs(there.gap) <= std::max(all.touching, with_rounding * rise)) note(primary, there.facet, turn);
  };
  for (std::size_t facet = 0; facet < secondary.facets.size(); ++facet) {
    const std::size_t corners = secondary.facets[facet].size();
    const auto at = [&](std::size_t k) {
      return static_cast<std::size_t>(surface_nodes.of_corner[static_cast<std::size_t>(secondary.facets.offset[facet]) + k]);
    };
    std::vector<const Opposite*> opposite;
    for (std::size_t k = 0; k < corners; ++k) {
      const Opposite& there = rays.meet(at(k));
      if (std::isfinite(there.gap)) note_opposite(there);
      if (std::abs(there.gap) <= all.touching) opposite.push_back(&there);
    }
    if (opposite.size() < corners) continue;
    const Point middle = secondary.geometry(facet).centre();
    double turn = turn_of(secondary, surface_nodes, facet);
    for (std::size_t k = 0; k < corners; ++k) {
      const std::size_t next = (k + 1) % corners;
      const double own = angle_between(surface_nodes.all[at(k)].normal, surface_nodes.all[at(next)].normal);
      const double beyond =
          angle_between(normal_at(primary, primary_nodes, *opposite[k]), normal_at(primary, primary_nodes, *opposite[next]));
      turn = std::max(turn, beyond - own);
    }
    const bool flat_on_flat = std::ranges::any_of(opposite, [&](const Opposite* there) {
      const auto face = primary.geometry(there->facet);
      return std::abs(face.normal().dot(middle - face.centre())) <= on_a_flat * rise_of(turn, secondary.geometry(facet).size());
    });
    if (!flat_on_flat) note(secondary, facet, turn);
  }
}

}  // namespace mortise::contact
