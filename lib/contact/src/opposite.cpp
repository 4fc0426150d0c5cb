#include "opposite.hpp"

#include <cmath>

#include "face_integrals.hpp"

namespace mortise::contact {

Rays::Rays(const Side& secondary, Places& places, const Side& primary, const Places& primary_places, const Tree& tree,
           const std::optional<Obstacle>& obstacle, double reach)
    : secondary_(secondary),
      places_(places),
      primary_(primary),
      primary_places_(primary_places),
      tree_(tree),
      reach_(reach),
      obstacle_(obstacle.has_value()),
      face_of_middle_(places.all.size(), {-1, -1}),
      known_(places.all.size(), -1)
{
  for (std::size_t f = 0; f < secondary.faces.size(); ++f)
    for (auto k = static_cast<std::size_t>(mesh::corner_count(secondary.faces.type[f])); k < secondary.faces[f].size(); ++k)
      face_of_middle_[static_cast<std::size_t>(places.of_node[static_cast<std::size_t>(secondary.faces.offset[f]) + k])] = {
          static_cast<Local>(f), static_cast<Local>(k)};
  if (!obstacle) return;
  // The directions of contact are the obstacle's normals; where a place does not face it, it is out of reach.
  for (auto& place : places.all) {
    Foot at = foot(*obstacle, secondary.points[static_cast<std::size_t>(place.node)]);
    if (place.normal.dot(at.normal) > opposed) at.distance = std::numeric_limits<double>::infinity();
    if (std::isfinite(at.distance)) place.normal = -at.normal;
    distance_.push_back(at.distance);
  }
}

Opposite Rays::shoot(std::size_t p, double length) const
{
  Opposite best;
  if (obstacle_) {
    best.gap = distance_[p];
    return best;
  }
  const Place& place = places_.all[p];
  const Point x = secondary_.points[static_cast<std::size_t>(place.node)];
  const Point margin = Point::Constant(0.02 * length);  // a hit may lie a little beside its face
  for (const int m : tree_.swept(Box(x - margin, x + margin), length * place.normal)) {
    const auto facet = static_cast<std::size_t>(m);
    const auto hit = contact::shoot(x, place.normal, primary_.geometry(facet));
    if (!hit.found) continue;
    const double gap = hit.distance - Bulge(primary_, primary_places_, facet)(hit.shape);
    if (std::abs(gap) <= length && std::abs(gap) < std::abs(best.gap)) best = {gap, facet, hit};
  }
  return best;
}

const Opposite& Rays::meet(std::size_t p)
{
  if (known_[p] < 0) {
    known_[p] = static_cast<Local>(met_.size());
    met_.push_back(shoot(p, reach_));
  }
  return met_[static_cast<std::size_t>(known_[p])];
}

double Rays::gap(std::size_t p, const GapOf& gap_of) const
{
  const auto at = [&](std::size_t place) {
    const Opposite opposite = shoot(place, 2 * reach_);
    return gap_of && std::isfinite(opposite.gap) ? gap_of(place, opposite) : opposite.gap;
  };
  const auto [face, node] = face_of_middle_[p];
  if (face < 0) return at(p);
  const auto f = static_cast<std::size_t>(face);
  const auto control = control_values(secondary_.faces.type[f]).row(node);
  double gap = 0;
  for (Eigen::Index k = 0; k < control.size(); ++k)
    if (control[k] != 0)
      gap += control[k] * at(static_cast<std::size_t>(places_.of_node[static_cast<std::size_t>(secondary_.faces.offset[f] + k)]));
  return gap;
}

}  // namespace mortise::contact
