// What a run tells on the way, and what it leaves behind.
#pragma once

#include <map>
#include <optional>

#include "analysis/approach.hpp"
#include "analysis/load_step_solver.hpp"
#include "analysis/memory.hpp"
#include "analysis/warnings.hpp"
#include "base/traffic.hpp"
#include "command_line.hpp"
#include "history.hpp"
#include "io/output_directory.hpp"
#include "io/summary.hpp"
#include "model/resolution.hpp"
#include "output/field_files.hpp"
#include "output/probe_files.hpp"

namespace mortise {

/// Lines on the terminal and files, as the stages of the method end, in the order of the functions below. All are collective.
/// Refers to its arguments. Neither copies nor moves.
class Report {
 public:
  /// Locks the output directory, but for --check. Throws as io::OutputDirectory.
  Report(const model::Deck& deck, const deck::Document& document, const CommandLine& command_line, const Context& context);
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// --check: nothing is solved or written.
  bool only_checks() const { return command_line_.check; }
  void mesh(const partition::Decomposition& decomposition);
  /// Removes what an earlier run left in the output directory.
  void resolution(const model::Resolution& resolved);

  /// An approach begins: the functions from here on are called again for the next one. Throws Error(no_equilibrium), see
  /// analysis::check_unconstrained_bodies.
  void rows(const model::Model& model, const analysis::Rows& first, const post::Probes& probes, std::size_t states,
            const analysis::Approach& approach);
  void memory(const model::Model& model, const analysis::Rows& first, const analysis::Memory& memory);
  void assembly(const analysis::Assembly& assembly, const std::vector<partition::CopyOf>& copies);

  void begin(const model::LoadState& acts);
  friction::Observer observer(const model::LoadState& acts);
  /// The solver has come to an end with this state. True if it gave up.
  bool gave_up(const analysis::LoadStepSolver& solver, const analysis::StepState& state, const analysis::Approach& approach);
  /// The files of a state, which has been evaluated.
  void write(const analysis::LoadStepSolver& solver, const analysis::StepState& state, const post::Probes& probes,
             post::Results results, const analysis::Approach& approach);
  /// A load step failed: leaves the results of those before, and throws the error, which names the load step then.
  [[noreturn]] void fail(const Error& error, const analysis::Approach& approach);
  /// For an error that ends the run: if it was told to end before any state was written, a summary that says so. Never throws.
  void tell_interrupted(const Error& error);
  /// The place of the present state, from 1.
  std::size_t state() const { return index_; }
  /// Whether another load step is to be solved after the one that was written.
  bool goes_on();

  /// The last lines, and what the run comes to.
  ExitStatus end();

 private:
  bool is_due(bool converged) const;
  void end_stage(const char* what, const char* name);
  void tell_stage(const char* what, const char* name);
  void write_summary(bool finished);

  const model::Deck& deck_;
  const CommandLine& command_line_;
  const Context& context_;
  double start_ = MPI_Wtime();
  double first_state_began_ = 0;
  Traffic before_all_ = traffic();
  std::optional<io::OutputDirectory> directory_;
  std::map<std::string, double> seconds_before_;  // of each stage, when it was last told
  History history_;
  std::optional<output::FieldFiles> files_;
  std::optional<output::ProbeFiles> probe_files_;
  analysis::Warnings warnings_;
  io::Summary sizes_as_cut_;  // of the deck's own cut, where it is solved by another one

  // of the approach, from rows() on
  const analysis::Assembly* assembly_ = nullptr;
  std::size_t states_ = 0, index_ = 0;  // how many there are; the place of the present one, from 1
  int increment_ = 0;                   // of the present step, from 1
  model::LoadState acts_;
  io::Summary summary_;    // of the states that are written; without a version if there is none
  post::Results results_;  // of the last of them
};

}  // namespace mortise
