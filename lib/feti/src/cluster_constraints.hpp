// B0: the averages that join the subdomains of a cluster.
#pragma once

#include <vector>

#include "base/cholesky.hpp"
#include "fem/stiffness.hpp"
#include "partition/decomposition.hpp"
#include "partition/node_directory.hpp"

namespace mortise::feti {

/// B0 on one subdomain of a cluster.
struct ClusterConstraint {
  SparseMatrix columns;  ///< B0' of its rows alone: unknowns x rows it takes part in
  std::vector<int> row;  ///< their numbers among the cluster's, ascending
};

/// The rows of B0 of the cluster of this rank's subdomains `first` .. `end`-1: for each two that share a face of a cell, the
/// rigid motions of the nodes of all such faces, orthonormal in the weights w_a w_b / (w_a + w_b) of the nodes' copies, times
/// these weights. Each is a sum of gluing rows and a unit vector in D^-1, D = diag(w). Rows of rings average motions in the
/// plane.
std::vector<ClusterConstraint> cluster_constraints(const partition::Decomposition& decomposition,
                                                   const partition::Interface& interface,
                                                   const std::vector<std::vector<double>>& weight, fem::Kinematics kinematics,
                                                   std::size_t first, std::size_t end);

/// Leaves out rows that are sums of others, to 1e-4 of their length in D^-1. Returns how many are left.
int drop_dependent(std::vector<ClusterConstraint>& constraints, const std::vector<std::vector<double>>& weight, int dimension,
                   std::size_t first);

}  // namespace mortise::feti
