// What a run tells of its load steps, and what it leaves behind.
#pragma once

#include <optional>

#include "analysis/load_step_solver.hpp"
#include "analysis/restart.hpp"
#include "output/field_files.hpp"
#include "output/probe_files.hpp"
#include "report.hpp"

namespace mortise {

/// The load steps of one approach, in the order of the functions below. All are collective. Refers to its arguments. Neither
/// copies nor moves.
class Report::LoadSteps {
 public:
  /// `states`: how many equilibria there are to be. `restart` keeps a record of each but the last, until all are solved.
  LoadSteps(Report& report, const analysis::Assembly& assembly, std::size_t states, analysis::Approach approach,
            const analysis::Restart& restart);
  LoadSteps(const LoadSteps&) = delete;
  LoadSteps& operator=(const LoadSteps&) = delete;

  /// The next state is about to be solved.
  void begin(const model::LoadState& acts);
  /// Writes the solver's progress to the history and on the terminal.
  analysis::Observer observer();
  /// The solver has come to an end with this state. True if it gave up.
  bool gave_up(const analysis::LoadStepSolver& solver, const analysis::StepState& state);
  /// The files of a state, which has been evaluated, and its record.
  void write(const analysis::LoadStepSolver& solver, const analysis::StepState& state, const post::Probes& probes,
             post::Results results);
  /// To be called where an exception is handled that a load step threw: the outcome of the attempt if another approach may do
  /// better, see analysis::failed; else leaves the results of the load steps before, and throws the error, which names the load
  /// step then.
  analysis::Outcome failed(const analysis::LoadStepSolver& solver);
  /// Whether another load step is to be solved after the one that was written.
  bool goes_on();

  /// The last lines, and what the run comes to.
  ExitStatus end();

 private:
  [[noreturn]] void fail(const Error& error);
  bool is_due(bool converged) const;
  void write_summary(bool finished);

  Report& run_;
  const model::Deck& deck_;
  const Context& context_;
  const analysis::Assembly& assembly_;
  const analysis::Approach approach_;
  const analysis::Restart& restart_;
  const std::size_t states_;
  std::size_t index_ = 0;  // of the present state, from 1
  int increment_ = 0;      // of the present step, from 1
  double first_state_began_ = 0;
  model::LoadState acts_;
  output::FieldFiles files_;
  output::ProbeFiles probe_files_;
  struct Written {
    io::Summary summary;  // of all states that are written
    post::Results results;
  };
  std::optional<Written> last_;
};

}  // namespace mortise
