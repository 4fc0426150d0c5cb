// Boundaries that are prescribed along their own normals or along local axes: planes of symmetry at an angle, the cuts of a
// sector, guides, bores.
#pragma once

#include <span>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "constraint/supports.hpp"
#include "mesh/mesh.hpp"

namespace mortise::constraint {

/// A node that supports[support] prescribes at `value`, a length, along the unit vector `direction`.
struct NodeDirection {
  Global node;
  int support;
  std::array<double, 3> direction;
  double value;
  std::array<double, 3> at{};  ///< the node's place
};

/// The normals at the nodes of `surfaces[i]`, this rank's faces of the boundary of supports[i], for all supports with a `normal`;
/// each on rank node % ranks, ascending by node. Faces round a node whose normals differ by less than 25 degrees have one normal
/// together, that of the smooth surface through the nodes (on circles and spheres exactly, but for the border of a surface);
/// beyond that the node lies on an edge and has the normals of both sides. Collective.
std::vector<NodeDirection> node_normals(std::span<const Support> supports, std::span<const mesh::Surface> surfaces,
                                        const Communicator& comm);

/// The same along the local axes of those supports that have some; `nodes[i]` as for dirichlet_rows(). A node that is nearer to
/// the axis of cylindrical ones than `rounding`, a length, is held across the axis where the radial displacement is given. That
/// must be 0 there: throws Error(bad_input) if it is not. Collective.
std::vector<NodeDirection> axes_directions(std::span<const Support> supports, std::span<const SupportNodes> nodes, int dimension,
                                           double rounding, const Communicator& comm);

/// Takes those that are parallel to an axis of the model out of `directions` and returns them as prescribed components, for
/// dirichlet_rows().
std::vector<PrescribedDof> take_axis_aligned(std::vector<NodeDirection>& directions);

/// What `directions`, ascending by node, hold besides the components `prescribed` of the same nodes, both of this rank's nodes
/// (node % ranks): rows along orthonormal directions. Throws Error(bad_input) that names both boundaries where they prescribe
/// different displacements. Collective.
std::vector<SkewSupport> skew_support_rows(std::span<const Support> supports, std::span<const NodeDirection> directions,
                                           std::span<const PrescribedDof> prescribed, const Communicator& comm);

}  // namespace mortise::constraint
