// Boundaries that are prescribed along their own normals: planes of symmetry at an angle, the cuts of a sector, guides.
#pragma once

#include <span>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "constraint/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::constraint {

/// A node of a boundary that supports[support] holds along the unit normal `direction` there.
struct NodeNormal {
  Global node;
  int support;
  std::array<double, 3> direction;
};

/// The normals at the nodes of `surfaces[i]`, this rank's faces of the boundary of supports[i], for all supports with a `normal`;
/// each on rank node % ranks, ascending by node. Faces round a node whose normals differ by less than 25 degrees have one normal
/// together, that of the smooth surface through the nodes (on circles and spheres exactly, but for the border of a surface);
/// beyond that the node lies on an edge and has the normals of both sides. Collective.
std::vector<NodeNormal> node_normals(std::span<const SupportOptions> supports, std::span<const mesh::Surface> surfaces,
                                     const Communicator& comm);

/// Those of `normals` that are parallel to an axis, as prescribed components for dirichlet_rows(); the others stay in `normals`.
std::vector<PrescribedDof> take_axis_aligned(std::span<const SupportOptions> supports, std::vector<NodeNormal>& normals);

/// What `normals` hold besides the components `prescribed` of the same nodes, both on this rank: orthonormal directions. Throws
/// Error(bad_input) that names both boundaries where they prescribe different displacements. Collective.
std::vector<SkewSupport> skew_support_rows(std::span<const SupportOptions> supports, std::span<const NodeNormal> normals,
                                           std::span<const PrescribedDof> prescribed, const Communicator& comm);

}  // namespace mortise::constraint
