// Integration rules on the reference cells, all with positive weights and points inside.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::fem {

/// An integration point in reference coordinates.
struct IntegrationPoint {
  Eigen::Vector3d at;
  double weight;
};

/// Exact for the stiffness of cells with straight edges and parallel faces.
std::vector<IntegrationPoint> integration_rule(mesh::CellType type);

}  // namespace mortise::fem
