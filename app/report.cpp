#include "report.hpp"

#include <utility>

#include "analysis/checks.hpp"
#include "analysis/memory.hpp"
#include "analysis/probes.hpp"
#include "base/interruption.hpp"
#include "initial_gaps.hpp"
#include "io/files.hpp"
#include "lines.hpp"
#include "listing.hpp"
#include "model/auto_contacts.hpp"
#include "output/summary.hpp"
#include "post/model_checks.hpp"

namespace mortise {

namespace {

using Kind = analysis::Approach::Kind;

}  // namespace

Report::Report(const model::Deck& deck, const deck::Document& document, const CommandLine& command_line, const Context& context)
    : deck_(deck), command_line_(command_line), context_(context), history_(deck.solver.programme, context)
{
  if (command_line.resume && context.comm.root()) {
    history_.take_up(io::text_of(deck.output.directory + "/history.csv"));
    sizes_as_cut_ = output::sizes_told(io::text_of(deck.output.directory + "/summary.json"));
  }
  if (command_line.check) return;
  std::vector files{document.file(), deck.mesh.file, deck.output.interior.point_file};
  for (const auto& load : deck.loads)
    if (load.temperature_change && load.temperature_change->file) files.push_back(load.temperature_change->file->file);
  directory_.emplace(deck.output.directory, files, context.comm);
}

void Report::end_stage(const char* what, const char* name)
{
  stop_if_requested(context_.comm);
  tell_stage(what, name);
}

// The line of a stage: the time since it was last asked for.
void Report::tell_stage(const char* what, const char* name)
{
  const double seconds = context_.timers.seconds(name);
  context_.log.line("  {:<22} {:8.2f} s", what, context_.comm.max(seconds - seconds_before_[name]));
  seconds_before_[name] = seconds;
}

void Report::mesh(const partition::Decomposition& decomposition)
{
  if (command_line_.check) print_listing(decomposition, deck_.kinematics, context_);
}

void Report::resolution(const model::Resolution& resolved)
{
  print_header(deck_, resolved.contacts, resolved.decomposition, context_);
  end_stage("mesh", "mesh");
  end_stage("partition", "partition");
  if (auto warning = print_contact_candidates(resolved.found, deck_, resolved.contacts, resolved.decomposition,
                                              command_line_.check, context_))
    warnings_.report(std::move(*warning), context_.log);
  if (directory_) directory_->clear(command_line_.resume);
}

bool Report::may_solve(const model::Model& model, const analysis::Rows& first, const std::vector<partition::CopyOf>& copies,
                       const post::Probes& probes, const analysis::Approach& approach)
{
  state_is_written_ = false;
  if (approach.kind == Kind::as_asked) {
    end_stage("supports and contact", "contact");
    warn(model, first, probes);
  }
  const auto memory = analysis::foresee_memory(model, copies, command_line_.check, context_.comm);
  if (command_line_.check) print_check(model, first.constraints, memory, context_);
  analysis::require(memory, model);
  return !command_line_.check;
}

void Report::warn(const model::Model& model, const analysis::Rows& first, const post::Probes& probes)
{
  auto& [comm, log, timers] = context_;
  const auto tell = [&](std::vector<Warning> warnings) {
    for (auto& warning : warnings) warnings_.report(std::move(warning), log);
  };
  tell(analysis::check_model(model, first, comm));
  tell(analysis::idle_planes(deck_, probes, comm));
  print_initial_gaps(first.initial_gaps, model.contacts(), command_line_.check, log);
  tell(post::unasked_overlaps(first.initial_gaps, model.contacts().options));
  tell(post::uneven_clearances(first.initial_gaps, model.contacts().options));
  tell(post::coarse_arcs(first.initial_gaps, model.contacts().options));
  tell(post::bonded_gaps(first.initial_gaps, model.contacts().options));
  analysis::check_unconstrained_bodies(model, first, context_, warnings_);
}

void Report::assembly(const analysis::Assembly& assembly, const std::vector<partition::CopyOf>& copies)
{
  end_stage("assembly", "assembly");
  end_stage("factorization", "factorization");
  print_copies(copies, assembly.decomposition(), context_);
  print_precision(copies, assembly.system().clusters.subdomains(), context_);
}

ExitStatus Report::watch(const std::function<ExitStatus()>& run)
{
  try {
    return run();
  } catch (const Error& error) {
    tell_interrupted(error);
    throw;
  }
}

// Never throws.
void Report::tell_interrupted(const Error& error)
{
  if (error.status() != ExitStatus::interrupted || state_is_written_ || !context_.comm.root()) return;
  const auto text = io::interrupted_summary(MORTISE_VERSION, deck_.title, static_cast<int>(error.status()));
  try {
    io::write_text(deck_.output.directory + "/summary.json", text);
  } catch (const Error&) {  // there is none, then
  }
}

}  // namespace mortise
