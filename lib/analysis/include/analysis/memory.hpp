// The memory that a run will need, foreseen before it is spent.
#pragma once

#include "base/context.hpp"
#include "model/model.hpp"
#include "partition/congruence.hpp"

namespace mortise::analysis {

/// Bytes, over all ranks.
struct Memory {
  double factors = 0;
  double total = 0;
  double excess = 0;  ///< of the machine that lacks most, what it will lack; negative if there is enough everywhere
};

/// Entries of the factor of a mesh with so many unknowns, up to a constant: n log n in planes, n^(4/3) in space.
double of_nested_dissection(double unknowns, int dimension);

/// From the analysis of the largest subdomain of each rank; the others' factors are scaled from it. `copies` as of
/// Model::congruent. Collective.
Memory foresee_memory(const model::Model& model, const std::vector<partition::CopyOf>& copies, const Communicator& comm);

/// Throws Error(machine) that says what would fit, if a machine has not enough. Collective.
void require(const Memory& memory, const model::Model& model);

}  // namespace mortise::analysis
