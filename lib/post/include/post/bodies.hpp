// What is known of each body as a whole, the same on every rank.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "contact/mortar.hpp"
#include "fem/options.hpp"
#include "partition/decomposition.hpp"

namespace mortise::post {

/// The largest value found on a body, and where.
struct Found {
  double value = -std::numeric_limits<double>::infinity();
  Point at = Point::Zero();
  int body = -1;  ///< of the catalogue, where it is told

  /// Keeps the larger of the two.
  void take(double other, const Point& place, int other_body = -1)
  {
    if (other > value) *this = {other, place, other_body};
  }
};

/// Of each body the largest value over all ranks; `mine`: of this rank, an entry for each body of the catalogue. Collective.
std::vector<Found> largest_of_ranks(const std::vector<Found>& mine, const Communicator& comm);

/// The size of each body: the diagonal of the box round it, in axisymmetry round the whole turn. Collective.
std::vector<double> body_sizes(const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                               const Communicator& comm);

/// Of each contact the bodies on its sides, ascending. Collective.
std::vector<std::vector<int>> bodies_of_contacts(std::span<const contact::Pair> pairs, const Communicator& comm);

}  // namespace mortise::post
