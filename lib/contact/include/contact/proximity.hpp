// How far bodies are from each other.
#pragma once

#include <limits>
#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

struct Nearest {
  int body = -1;  ///< -1: there is no other
  double distance = std::numeric_limits<double>::infinity();
};

/// For each body that is `wanted` the body next to it: the smallest distance from the corners of one's faces to the other's
/// faces, which crossing edges may undercut a little. `skin` are the outer faces of all bodies. All faces of the wanted bodies
/// are gathered on every rank: for bodies that went astray, which are few. Collective.
std::vector<Nearest> nearest_bodies(const mesh::Surface& skin, const std::vector<bool>& wanted, const Communicator& comm);

}  // namespace mortise::contact
