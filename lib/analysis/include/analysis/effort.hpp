// What a direct solution would cost, bodies taken whole, beside products with F.
#pragma once

#include <optional>

#include "analysis/assembly.hpp"
#include "constraint/constraints.hpp"
#include "qp/budget.hpp"
#include "qp/limits.hpp"

namespace mortise::analysis {

struct DirectEffort {
  Global multipliers = 0;  ///< dual unknowns with bodies taken whole, but for those that are eliminated
  double products = 0;     ///< how many products with F on the present decomposition take as long
  double seconds = 0;      ///< roughly, on one core
  double bytes = 0;        ///< of memory, at most, on the rank that needs most
  bool sparse = false;     ///< by sparse matrices, whose size hardly depends on the number of multipliers

  /// With dense matrices.
  bool too_many() const { return !sparse && multipliers > qp::limits::Automatic::most_multipliers; }
};

/// What a direct solution costs, from the sizes of the present factors and the laws of nested dissection and an order of the
/// interface; nothing is factorized for it. The same on every rank and, but for rounding, for every number of ranks. Collective.
DirectEffort effort_of_direct(const Assembly& assembly, const constraint::Constraints& constraints, const Communicator& comm);

/// The products with F after which a direct solution is worth more than going on; nothing where it is out of reach. Collective.
std::optional<qp::Patience> patience_with_products(const DirectEffort& effort, const Communicator& comm);

/// Throws Error(machine) on all ranks if any machine has no room for a direct solution. Collective.
void require_room_for_direct(const DirectEffort& effort, const Communicator& comm);

}  // namespace mortise::analysis
