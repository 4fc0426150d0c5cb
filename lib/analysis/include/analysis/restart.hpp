// Runs that go on where an earlier one was ended. Each load state leaves what its equilibrium is made of, multipliers and
// amplitudes of rigid motions; whatever else there is to know of it, friction's memory and all results, follows from them as it
// did then.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/approach.hpp"
#include "base/tpetra.hpp"

namespace mortise::analysis {

class LoadStepSolver;
struct StepState;

/// What a state leaves. The same on every rank.
struct Record {
  double time = 0;  ///< of the state
  Approach approach;
  std::string file;            ///< has the vectors
  std::vector<double> counts;  ///< figures of friction::Result and qp::Solution, see restart.cpp
};

/// The records of a directory, restart.1.h5 and so on: those of the run at hand, and those of one before, if it is resumed.
class Restart {
 public:
  /// In the deck's output directory. Throws Error(bad_input) if there is nothing to resume, or it is of another deck or another
  /// number of ranks. Collective.
  Restart(const model::Deck& deck, bool resume, const Communicator& comm);

  /// How the run before went about it, if it is resumed.
  std::optional<Approach> approach() const;
  /// What it left of the state at this time; null if nothing.
  const Record* find(const Approach& approach, double time) const;
  /// Writes that of a state, the `index`-th, from 1. Throws Error(machine). Collective.
  void keep(std::size_t index, const Approach& approach, const LoadStepSolver& solver, const StepState& state) const;
  /// The run has come to its end: removes all records. Never throws. Collective.
  void remove() const;

 private:
  std::string path(std::size_t index) const;

  std::string directory_;
  const Communicator& comm_;
  std::vector<Record> records_;
};

/// The solution that a record tells of, for the problem that it comes from; puts the radii into the problem's set. Throws
/// Error(bad_input) if it is another problem, of a mesh or of temperatures that were changed, say. Collective.
friction::Result solution_of(const Record& record, feti::DualProblem& problem);

}  // namespace mortise::analysis
