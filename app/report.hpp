// What a run tells on the way to its load steps.
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "analysis/approach.hpp"
#include "analysis/assembly.hpp"
#include "analysis/warnings.hpp"
#include "base/traffic.hpp"
#include "command_line.hpp"
#include "history.hpp"
#include "io/output_directory.hpp"
#include "io/summary.hpp"
#include "model/resolution.hpp"

namespace mortise {

/// Lines on the terminal and files, as the stages of the method end: a function for each stage, which takes what the stage made
/// and asks for none of the others. What the load steps of an approach leave is told by Report::LoadSteps (load_steps.hpp). All
/// are collective. Refers to its arguments. Neither copies nor moves.
class Report {
 public:
  class LoadSteps;

  /// Locks the output directory, but for --check. Throws as io::OutputDirectory.
  Report(const model::Deck& deck, const deck::Document& document, const CommandLine& command_line, const Context& context);
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// --check lists bodies and boundaries.
  void mesh(const partition::Decomposition& decomposition);
  /// Removes what an earlier run left in the output directory.
  void resolution(const model::Resolution& resolved);

  /// An approach begins: the functions from here on are called again for the next one. Warns of the model, and foresees the
  /// memory of the run. False with --check, which ends here. Throws Error(no_equilibrium), see
  /// analysis::check_unconstrained_bodies, and Error(machine) if there is not enough memory.
  bool may_solve(const model::Model& model, const analysis::Rows& first, const std::vector<partition::CopyOf>& copies,
                 const post::Probes& probes, const analysis::Approach& approach);
  void assembly(const analysis::Assembly& assembly, const std::vector<partition::CopyOf>& copies);

  /// Calls `run`. If that is told to end before any state was written, leaves a summary that says so, and throws on.
  ExitStatus watch(const std::function<ExitStatus()>& run);

 private:
  void warn(const model::Model& model, const analysis::Rows& first, const post::Probes& probes);
  void tell_interrupted(const Error& error);
  void end_stage(const char* what, const char* name);
  void tell_stage(const char* what, const char* name);

  const model::Deck& deck_;
  const CommandLine& command_line_;
  const Context& context_;
  double start_ = MPI_Wtime();
  Traffic before_all_ = traffic();
  std::optional<io::OutputDirectory> directory_;  // none with --check
  std::map<std::string, double> seconds_before_;  // of each stage, when it was last told
  History history_;
  analysis::Warnings warnings_;
  io::Summary sizes_as_cut_;       // of the deck's own cut, where it is solved by another one
  bool state_is_written_ = false;  // one of the present approach
};

}  // namespace mortise
