// Runs that go on where an earlier one was ended. Each load state leaves a record of its multipliers, slip bounds and amplitudes
// of rigid motions; slip and all results follow from these as they did in the earlier run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/approach.hpp"
#include "base/tpetra.hpp"

namespace mortise::analysis {

struct StepState;

/// The record of a load state. The same on every rank.
struct Record {
  double time = 0;             ///< of the state
  Approach approach;           ///< by which it was solved
  std::string file;            ///< holds the vectors
  std::vector<double> counts;  ///< figures of feti::DualSolution and qp::Solution, see restart.cpp
};

/// The records in a directory, restart.1.h5 and so on: those that this run keeps, and those of an earlier one that it resumes.
class Restart {
 public:
  /// Those in the deck's output directory, read if the run is to `resume`. Throws Error(bad_input) if there is nothing to resume,
  /// or it is of another deck or another number of ranks. Collective.
  Restart(const model::Deck& deck, bool resume, const Communicator& comm);

  /// The approach of the earlier run, if it is resumed.
  std::optional<Approach> approach() const;
  /// Its record of the state at this time by this approach; null if there is none.
  const Record* find(const Approach& approach, double time) const;
  /// Writes the record of a state, the `index`-th, from 1. Throws Error(machine). Collective.
  void keep(std::size_t index, const Approach& approach, const StepState& state) const;
  /// Removes all records, for a run that has come to its end: rank 0 does so, the others return. Never throws.
  void remove() const;

 private:
  std::string path(std::size_t index) const;

  std::string directory_;
  const Communicator& comm_;
  std::vector<Record> records_;
};

/// The solution that a record holds, by one product with F, `hessian`. Throws Error(bad_input) if the record is of another
/// problem, as that of a mesh that has changed. Collective.
feti::DualSolution solution_of(const Record& record, const feti::DualProblem& problem, const Operator& hessian);

}  // namespace mortise::analysis
