// The memory that a run will need, foreseen before it is spent.
#pragma once

#include "base/context.hpp"
#include "model/model.hpp"
#include "partition/congruence.hpp"

namespace mortise::analysis {

/// Bytes, the same on every rank.
struct Memory {
  double factors = 0;  ///< of all subdomains of all ranks
  double total = 0;    ///< of all ranks
  double excess = 0;   ///< what the machine that lacks most will lack; negative if there is enough everywhere
};

/// Entries of the factor of a mesh with n unknowns by nested dissection, up to a constant: n log n in planes, n^(4/3) in space.
double of_nested_dissection(double unknowns, int dimension);

/// The memory of a run, from the analysis of the largest subdomain of each rank; the factors of the others are scaled from its.
/// Unless `exact`, a bound from above does where that is no more than there is: the analysis takes a third of the time of a
/// factorization. `copies` as of Model::congruent. Collective.
Memory foresee_memory(const model::Model& model, const std::vector<partition::CopyOf>& copies, bool exact,
                      const Communicator& comm);

/// Throws Error(machine), on every rank alike, that says what would fit, if a machine has not enough.
void require(const Memory& memory, const model::Model& model);

}  // namespace mortise::analysis
