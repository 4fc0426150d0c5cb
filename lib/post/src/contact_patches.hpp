// Where contacts press, and what the faces there are like: whether a body may turn or roll on them.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "contact_nodes.hpp"

namespace mortise::post {

/// From face to face, in radians: less is no corner, more (a hexagon's is 1.05) is an edge of the body, not its mesh's.
inline constexpr double flat = 1e-3, edge = 1.1;

/// The faces at what presses, of one side: the angle between two of them where the surface is flattest, at nodes between corners
/// none; at corners its smallest radius, and whether it is round at all of them; their size, whose they are; their normals, times
/// the forces.
struct Facets {
  double flattest = std::numeric_limits<double>::infinity(), radius = flattest, size = 0;
  int body = -1;
  bool round = true;
  Point normals = Point::Zero();

  void take(const Nodal& node)
  {
    flattest = std::min(flattest, node.angle());
    if (!node.corner) return;
    const double angle = node.angle();
    round = round && angle > flat;
    if (angle > flat) radius = std::min(radius, node.size / angle);
    size = std::max(size, node.size);
    body = std::max(body, node.body);
  }
};

/// Where a contact presses: how far along two directions of its surface (one in planes), of which the first is the narrowest, and
/// on which faces of its secondary and its primary side. `stuck`: the part of the force at points that stick; `shear`: the forces
/// along the surface, added up as numbers.
struct Patch {
  double force = 0, stuck = 0, shear = 0;
  Point normal = Point::Zero(), centre = Point::Zero();
  std::vector<Point> directions = {};
  std::vector<double> widths = {};
  std::array<Facets, 2> sides = {};
};

/// Of each contact; the same on all ranks. Collective.
std::vector<Patch> pressing_patches(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                    std::span<const contact::ContactNodeState> states,
                                    const std::unordered_map<Global, Nodal>& nodes, int dimension, const Communicator& comm);

}  // namespace mortise::post
