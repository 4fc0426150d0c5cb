#include "gaps/starting_gaps.hpp"

#include <cmath>

namespace mortise::contact {

namespace {

// Of the distance that the search goes, and of a place's distance from the origin.
constexpr double rounding_of_gap = 1e-12, rounding_of_coordinates = 1e-15;

}  // namespace

// Of places that coordinates say are the same the gap is 0: bodies that touch without a load press with nothing then. Nor is an
// overlap that is next to nothing of what the sides come nearer between a node and `at`, or of what stands out of a facet there:
// surfaces are known no better. So it is with the control value of a node in the middle beside a corner that a ball touches.
double StartingGaps::without_rounding(std::size_t surface_node, Beyond beyond, double gap, const Point& at,
                                      const Point& direction)
{
  constexpr double of_surfaces = 0.02;
  if (gap < 0 && beyond != Beyond::nothing) {
    if (const double at_node = rays_.meet(surface_node).gap; std::isfinite(at_node) && -gap < of_surfaces * (at_node - gap))
      return 0;
    if (beyond == Beyond::nearest_place && !options_.obstacle &&
        -gap < of_surfaces * rays_.rise_of(rays_.met_from(surface_node, at, direction)))
      return 0;
  }
  return std::abs(gap) < rounding_of_gap * reach_ + rounding_of_coordinates * at.norm() ? 0 : gap;
}

// What the contact starts with where a line from a surface node meets something.
Rays::GapOf StartingGaps::start() const
{
  return [this](std::size_t surface_node, const Opposite& opposite) {
    // An obstacle has no faces, and no surface of the geometry.
    const bool one =
        one_surface_.anywhere() && one_surface_.holds(surface_node, static_cast<std::size_t>(primary_.face_of[opposite.facet]));
    return starting_gap(options_, opposite.gap, one);
  };
}

StartingGaps::Gaps StartingGaps::at_node(std::size_t place, bool nearest, const Point& at, const Point& direction, double mean,
                                         std::span<const Term> terms)
{
  const Beyond beyond = nearest                                              ? Beyond::nearest_place
                        : !faces_.is_corner(place) && rays_.at_middle(place) ? Beyond::control_value
                                                                             : Beyond::nothing;
  const auto of = [&](double gap) { return without_rounding(place, beyond, gap, at, direction); };
  const double mesh = of(points_.gap(place, direction, mean));
  if (starts_in_mesh()) return {mesh, mesh};
  const double mean_start = starting_gap(options_, mean, one_surface_.holds(faces_.surface_node(place), terms));
  return {mesh, of(points_.gap(place, direction, mean_start, start()))};
}

StartingGaps::Gaps StartingGaps::between_nodes(const ContactPoint& place, const Point& direction)
{
  const auto p = place.surface_node;
  const auto gap = [&](const Rays::GapOf& gap_of) {
    return without_rounding(p, Beyond::nearest_place, rays_.gap(p, place.where, direction, gap_of), place.at, direction);
  };
  const double mesh = gap({});
  return {mesh, starts_in_mesh() ? mesh : gap(start())};
}

}  // namespace mortise::contact
