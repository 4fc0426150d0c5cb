#include "report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "analysis/checks.hpp"
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

// Times count steps, and are whole numbers at their ends.
bool ends_a_step(const model::LoadState& acts)
{
  return acts.time == std::floor(acts.time);
}

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
  print_contact_candidates(resolved.found, deck_, resolved.contacts, resolved.decomposition, command_line_.check, context_);
  if (directory_) directory_->clear(command_line_.resume);
}

void Report::rows(const model::Model& model, const analysis::Rows& first, const post::Probes& probes, std::size_t states,
                  const analysis::Approach& approach)
{
  auto& [comm, log, timers] = context_;
  states_ = states;
  index_ = 0;
  summary_ = {};
  increment_ = 0;
  acts_ = {};
  files_.emplace(deck_);
  probe_files_.emplace(deck_);
  if (approach.kind == Kind::as_asked) {
    end_stage("supports and contact", "contact");
    for (auto& warning : analysis::check_model(model, first, comm)) warnings_.report(std::move(warning), log);
    for (auto& warning : analysis::idle_planes(deck_, probes, comm)) warnings_.report(std::move(warning), log);
    print_initial_gaps(first.initial_gaps, model.contacts(), command_line_.check, log);
    for (auto& warning : post::unasked_overlaps(first.initial_gaps, model.contacts().options))
      warnings_.report(std::move(warning), log);
    analysis::check_unconstrained_bodies(model, first, context_, warnings_);
  }
}

void Report::memory(const model::Model& model, const analysis::Rows& first, const analysis::Memory& memory)
{
  if (command_line_.check) print_check(model, first.constraints, memory, context_);
}

void Report::assembly(const analysis::Assembly& assembly, const std::vector<partition::CopyOf>& copies)
{
  assembly_ = &assembly;
  end_stage("assembly", "assembly");
  end_stage("factorization", "factorization");
  print_copies(copies, assembly.decomposition(), context_);
}

void Report::begin(const model::LoadState& acts)
{
  increment_ = ends_a_step(acts_) ? 1 : increment_ + 1;
  acts_ = acts;
  if (index_ == 0) first_state_began_ = MPI_Wtime();
  const double each = index_ > 0 ? (MPI_Wtime() - first_state_began_) / static_cast<double>(index_) : 0;
  print_state(acts, index_, states_, each * static_cast<double>(states_ - index_), context_.log);
  ++index_;
}

friction::Observer Report::observer(const model::LoadState& acts)
{
  return [this, acts](int step, double change, const qp::Progress& p) { history_.note(acts, step, change, p); };
}

// Whether the fields of the present state are to be written.
bool Report::is_due(bool converged) const
{
  return ends_a_step(acts_) || !converged || increment_ % deck_.output.every == 0;
}

bool Report::gave_up(const analysis::LoadStepSolver& solver, const analysis::StepState& state, const analysis::Approach& approach)
{
  context_.log.end_progress();
  end_stage("solve", "solve");
  if (!state.solved.gave_up) return false;
  if (approach.kind != Kind::direct_instead)
    sizes_as_cut_ = output::sizes_of(assembly_->decomposition(), solver.problem(), context_.comm);
  return true;
}

void Report::write(const analysis::LoadStepSolver& solver, const analysis::StepState& state, const post::Probes& probes,
                   post::Results results, const analysis::Approach& approach)
{
  const auto& comm = context_.comm;
  const auto& model = assembly_->model();
  const output::EvaluatedState found{model.decomposition(), assembly_->interface(), solver.problem(), state, probes, results};
  const bool first = summary_.version.empty();
  auto summary = output::summarise(model, found, comm);
  summary.version = MORTISE_VERSION;
  summary.algorithm = approach.algorithm == "auto" ? "face_newton" : approach.algorithm;
  if (approach.kind == Kind::direct_instead && sizes_as_cut_.subdomains > 0) output::copy_sizes(sizes_as_cut_, summary);
  if (first) summary.hessian_multiplications += solver.spent_before();
  output::accumulate_steps(acts_, summary_, summary);
  warnings_.add(analysis::check_results(model, state, results, comm));
  {
    const auto scope = context_.timers.scope("output");
    files_->write(found, is_due(summary.converged), index_ == states_ || !summary.converged, comm);
    probe_files_->write(model.decomposition().catalogue, acts_, probes, results, summary.probes, comm);
    collectively(comm, [&] {
      if (!comm.root()) return;
      io::write_text(deck_.output.directory + "/history.csv", history_.text());
      if (first) io::write_text(deck_.output.directory + "/deck.yaml", io::written_mark() + "\n" + write_deck(deck_));
    });
  }
  summary_ = std::move(summary);  // now that what it tells is on the disk
  results_ = std::move(results);
  tell_stage("output", "output");  // does not end the run: a state that is written is to be kept for --resume
}

void Report::fail(const Error& error, const analysis::Approach& approach)
{
  context_.log.end_progress();
  if (analysis::is_tried_again(approach, error)) throw error;
  if (summary_.version.empty()) throw error;  // no state is written
  summary_.converged = false;
  summary_.exit_status = static_cast<int>(error.status());
  try {
    write_summary(true);
  } catch (const Error&) {  // the one on the disk says that the run is not finished
  }
  throw Error(error.status(), fmt::format("step {}, time {:.4g}: {}\nThe results of the states before are written.", acts_.step,
                                          acts_.time, error.what()));
}

void Report::tell_interrupted(const Error& error)
{
  if (error.status() != ExitStatus::interrupted || !summary_.version.empty() || !context_.comm.root()) return;
  const auto text = io::interrupted_summary(MORTISE_VERSION, deck_.title, static_cast<int>(error.status()));
  try {
    io::write_text(deck_.output.directory + "/summary.json", text);
  } catch (const Error&) {  // there is none, then
  }
}

bool Report::goes_on()
{
  if (index_ == states_) return false;
  if (!summary_.converged) {
    context_.log.line("Step {} did not converge; the {} states after it are not solved.", acts_.step, states_ - index_);
    return false;
  }
  print_step(summary_, context_.log);
  write_summary(false);
  return true;
}

void Report::write_summary(bool finished)
{
  const auto& comm = context_.comm;
  summary_.finished = finished;
  summary_.warnings = warnings_.all();
  summary_.time["total"] = comm.max(MPI_Wtime() - start_);
  summary_.peak_memory_bytes = comm.sum(static_cast<double>(peak_memory()));
  collectively(comm, [&] {
    if (comm.root()) io::write_text(deck_.output.directory + "/summary.json", io::to_json(summary_));
  });
}

ExitStatus Report::end()
{
  auto& [comm, log, timers] = context_;
  output::note_communication(timers, traffic() - before_all_, comm, summary_);
  const auto spreads = timers.spread(comm);
  for (const auto& spread : spreads) summary_.time[spread.stage] = spread.max;
  write_summary(true);
  print_results(results_, summary_, log);
  print_probes(summary_, log);
  log.line("  time and memory     {:.2f} s, {:.2f} GB; results in {}", summary_.time["total"], summary_.peak_memory_bytes / 1e9,
           deck_.output.directory);
  print_communication(summary_, log);
  print_times(spreads, log);
  print_warnings(warnings_, log);
  return results_.verdict.status;
}

}  // namespace mortise
