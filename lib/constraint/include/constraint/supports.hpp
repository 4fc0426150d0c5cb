// Prescribed displacements of boundaries, resolved to nodes.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "deck/formula.hpp"
#include "deck/local_axes.hpp"

namespace mortise::constraint {

/// What a support prescribes in one load state.
struct Support {
  std::string boundary;                                           ///< for messages
  std::array<std::optional<deck::Formula>, 3> displacement = {};  ///< along x, y, z, or the local axes
  std::optional<deck::Formula> normal = {};                       ///< along the boundary's own outward normal
  std::optional<deck::LocalAxes> axes = {};
  std::string name = {};

  /// Whether what it prescribes does not vary in space.
  bool is_uniform() const;
  bool operator==(const Support& other) const = default;
};

/// Nodes of this rank and where they are. Copies of a node are fine.
struct SupportNodes {
  std::vector<Global> id;
  std::vector<Point> at;
};

/// Every prescribed pair (node, component) once over all ranks, on rank node % ranks, ascending. `nodes[i]` are the nodes of this
/// rank on the boundary of `supports[i]`; copies of a node on several ranks and nodes on several boundaries are fine. Supports
/// with local axes are left to normals.hpp. `aligned`: components that stand on this rank and are prescribed besides (see
/// take_axis_aligned(), coupled_rows()). Where supports overlap they must agree: throws Error(bad_input) that names both if they
/// prescribe different values, or one whose formula is no number at a node. Collective.
std::vector<PrescribedDof> dirichlet_rows(std::span<const Support> supports, std::span<const SupportNodes> nodes, int dimension,
                                          const Communicator& comm, std::span<const PrescribedDof> aligned = {});

/// The value of a formula of supports[support] at a place. Throws Error(bad_input) where that is no number.
double value_at(std::span<const Support> supports, int support, const deck::Formula& formula, const Point& place);

/// Throws Error(bad_input): supports[support] holds a node that moves with supports[coupling], which stands for a rigid coupling,
/// by something unknown.
[[noreturn]] void throw_prescribed_coupling(std::span<const Support> supports, int coupling, int support);

}  // namespace mortise::constraint
