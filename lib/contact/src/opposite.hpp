// What lies opposite a place, along its normal: a smooth primary side or a rigid obstacle.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "contact/obstacle.hpp"
#include "places.hpp"
#include "tree.hpp"

namespace mortise::contact {

struct Opposite {
  double gap = std::numeric_limits<double>::infinity();  ///< between the smooth surfaces; infinite: nothing is there
  std::size_t facet = 0;                                 ///< of the primary side
  Hit hit;
};

class Rays {
 public:
  /// All of which must outlive it; `tree` has the facets of the primary side. Turns the normals of the places at which an
  /// obstacle lies opposite into the direction of contact, that of the obstacle.
  Rays(const Side& secondary, Places& places, const Side& primary, const Places& primary_places, const Tree& tree,
       const std::optional<Obstacle>& obstacle, double reach);

  /// What is next to a place on the line along its normal, both ways, nearer than `length`. An obstacle is met at any distance.
  Opposite shoot(std::size_t place, double length) const;
  /// What is within reach; looked up once for each place.
  const Opposite& meet(std::size_t place);
  bool meets(std::size_t place) { return std::abs(meet(place).gap) <= reach_; }
  /// The gap at a place as the rows see it: in the middle of edges and faces as a control value, see multiplier_basis().
  /// Infinite if one of the lines meets nothing within twice the reach.
  /// `gap_of`: takes another gap than that of the meshes where a line meets something.
  using GapOf = std::function<double(std::size_t place, const Opposite&)>;
  double gap(std::size_t place, const GapOf& gap_of = {}) const;

 private:
  const Side& secondary_;
  const Places& places_;
  const Side& primary_;
  const Places& primary_places_;
  const Tree& tree_;
  double reach_;
  bool obstacle_;
  std::vector<double> distance_;                         // of each place from the obstacle, if there is one
  std::vector<std::pair<Local, Local>> face_of_middle_;  // of each place: a face and the node in it, if that is no corner
  std::vector<Opposite> met_;
  std::vector<Local> known_;  // of each place its entry in met_, or -1
};

}  // namespace mortise::contact
