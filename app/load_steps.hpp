// What a run tells of its load steps, and what it leaves behind.
#pragma once

#include <optional>

#include "analysis/load_step_solver.hpp"
#include "analysis/restart.hpp"
#include "output/field_files.hpp"
#include "output/probe_files.hpp"
#include "report.hpp"

namespace mortise {

/// The load steps of one approach. What a function needs of those before it comes as an argument. All are collective. Refers to
/// its arguments. Neither copies nor moves.
class Report::LoadSteps {
 public:
  /// A state that is being solved.
  struct Begun {
    model::LoadState acts;
    std::size_t index = 1;  ///< of the state, from 1
    int increment = 1;      ///< of its step, from 1
  };
  /// A state whose files are written.
  struct Written {
    Begun state;
    io::Summary summary;  ///< of all states that are written
    post::Balance balance;
    post::Verdict verdict;
  };

  /// `states`: how many equilibria there are to be. `restart` keeps a record of each but the last, until all are solved.
  LoadSteps(Report& report, const analysis::Assembly& assembly, std::size_t states, analysis::Approach approach,
            const analysis::Restart& restart);
  LoadSteps(const LoadSteps&) = delete;
  LoadSteps& operator=(const LoadSteps&) = delete;

  /// The state after `before`, or the first one, is about to be solved.
  Begun begin(const model::LoadState& acts, const std::optional<Written>& before) const;
  /// Writes the solver's progress to the history and on the terminal.
  analysis::Observer observer(const Begun& begun);
  /// The solver has come to an end with this state. True if it gave up.
  bool gave_up(const analysis::StepState& state);
  /// The files of a state, which has been evaluated; `before` as for begin().
  Written write(const Begun& begun, const analysis::StepState& state, const post::Probes& probes, const post::Results& results,
                const std::optional<Written>& before);
  /// Its record, from which a run goes on.
  void keep(const Written& written, const analysis::StepState& state) const;
  /// To be called where an exception is handled that a load step threw: the outcome of the attempt if another approach may do
  /// better, see analysis::failed; else leaves the results of the load steps `before`, and throws the error, which names the load
  /// step then.
  analysis::Outcome failed(const Begun& begun, const analysis::LoadStepSolver& solver, std::optional<Written>& before) const;
  /// Whether another load step is to be solved after the last one that was written. If so writes the summary so far.
  bool goes_on(Written& last) const;

  /// The last lines, and what the run comes to.
  ExitStatus end(Written& last) const;

 private:
  [[noreturn]] void fail(const Error& error, const Begun& begun, std::optional<Written>& before) const;
  bool is_due(const Begun& begun, const post::Verdict& verdict) const;
  void write_summary(io::Summary& summary, bool finished) const;

  Report& run_;
  const model::Deck& deck_;
  const Context& context_;
  const analysis::Assembly& assembly_;
  const analysis::Approach approach_;
  const analysis::Restart& restart_;
  const std::size_t states_;
  const double began_ = MPI_Wtime();
  output::FieldFiles files_;
  output::ProbeFiles probe_files_;
};

}  // namespace mortise
