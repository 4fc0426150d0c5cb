// What a row of a contact needs to know of its nodes, whichever rank has them.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <vector>

#include "contact/state.hpp"
#include "partition/decomposition.hpp"

namespace mortise::post {

/// Of a node its displacement and body, the size of the faces of secondary sides at it, that of all, and the sum
/// of their unit normals.
struct Nodal {
  Global node;
  double u[3] = {0, 0, 0};
  int body = 0;
  double secondary_size = 0, size = 0;
  double normals[3] = {0, 0, 0}, faces = 0;
  bool corner = false;  ///< of a face

  void take(const Nodal& other)
  {
    secondary_size = std::max(secondary_size, other.secondary_size);
    size = std::max(size, other.size);
    for (int c = 0; c < 3; ++c) normals[c] += other.normals[c];
    faces += other.faces;
    corner = corner || other.corner;
  }
  Point normal() const { return Eigen::Map<const Point>(normals).normalized(); }
  /// Between two faces at the node, about: the normals of two stand at half of it to their mean.
  double angle() const { return 2 * std::acos(std::min(Eigen::Map<const Point>(normals).norm() / std::max(faces, 1.0), 1.0)); }
};

/// Whether a contact node is closed, in a contact whose sides may move along each other.
bool touches(std::span<const contact::Pair> pairs, const contact::ContactNodeState& point);

/// Of the nodes in rows of closed points. Collective.
std::unordered_map<Global, Nodal> nodes_at_contact(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                                   std::span<const contact::ContactNodeState> states,
                                                   const partition::Decomposition& decomposition,
                                                   const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

}  // namespace mortise::post
