// Prescribed displacements of boundaries, resolved to nodes.
#pragma once

#include <span>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "constraint/options.hpp"

namespace mortise::constraint {

/// Every prescribed pair (node, component) once over all ranks, on rank node % ranks, ascending. `nodes[i]` are the nodes of this
/// rank on the boundary of `supports[i]`; copies of a node on several ranks and nodes on several boundaries are fine. Where
/// supports overlap they must agree: throws Error(bad_input) that names both if they prescribe different values. `aligned`:
/// components that stand on this rank and are prescribed besides (see take_axis_aligned(), coupled_rows()). Collective.
std::vector<PrescribedDof> dirichlet_rows(std::span<const SupportOptions> supports, std::span<const std::vector<Global>> nodes,
                                          int dimension, const Communicator& comm, std::span<const PrescribedDof> aligned = {});

/// Throws Error(bad_input): supports[support] holds a node that moves with supports[coupling], which stands for a rigid coupling,
/// by something unknown.
[[noreturn]] void throw_held_coupling(std::span<const SupportOptions> supports, int coupling, int support);

}  // namespace mortise::constraint
