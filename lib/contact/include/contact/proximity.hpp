// How far bodies are from each other.
#pragma once

#include <limits>
#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// The body nearest to another one.
struct Nearest {
  int body = -1;  ///< -1: there is no other body
  double distance = std::numeric_limits<double>::infinity();
};

/// For each body that is `wanted` the body nearest to it, by the smallest distance from the corners of the faces of either to the
/// faces of the other (edges that cross may be a little nearer). `skin`: the outer faces of all bodies, this rank's. All faces of
/// the wanted bodies are gathered on every rank: meant for a few bodies that touch nothing. Collective.
std::vector<Nearest> nearest_bodies(const mesh::Surface& skin, const std::vector<bool>& wanted, const Communicator& comm);

}  // namespace mortise::contact
