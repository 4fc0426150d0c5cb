// Nodes that supports and loads name by their places.
#pragma once

#include "model/model.hpp"

namespace mortise::model {

inline Point place(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

/// A node of a body's surface: nearest to a place, or of a set with a name. Copies of it: the one in the first subdomain.
struct Model::NodeAtPoint {
  double distance = std::numeric_limits<double>::infinity();
  Global node = -1, subdomain = -1;  ///< -1: none
  int body = -1;
  Local local = -1;  ///< in that subdomain's mesh
  Point at = Point::Zero();
  double share = 1;  ///< of what acts on all nodes of the place; these sum to 1
};

/// Those of the places of each of the deck's supports, loads and springs. The same on every rank.
struct Model::NodesAtPoints {
  std::vector<std::vector<NodeAtPoint>> supports, loads;
  std::vector<std::vector<NodeAtPoint>> springs;  ///< two of each, by name
};

}  // namespace mortise::model
