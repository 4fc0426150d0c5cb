#include "load_steps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "analysis/checks.hpp"
#include "base/timer.hpp"
#include "io/files.hpp"
#include "lines.hpp"
#include "output/summary.hpp"
#include "qp/solver.hpp"

namespace mortise {

namespace {

// Times count steps, and are whole numbers at their ends.
bool ends_a_step(const model::LoadState& acts)
{
  return acts.time == std::floor(acts.time);
}

}  // namespace

Report::LoadSteps::LoadSteps(Report& report, const analysis::Assembly& assembly, std::size_t states, analysis::Approach approach,
                             const analysis::Restart& restart)
    : run_(report),
      deck_(report.deck_),
      context_(report.context_),
      assembly_(assembly),
      approach_(std::move(approach)),
      restart_(restart),
      states_(states),
      files_(deck_),
      probe_files_(deck_)
{
}

auto Report::LoadSteps::begin(const model::LoadState& acts, const std::optional<Written>& before) const -> Begun
{
  Begun begun{acts};
  double left = 0;
  if (before) {
    const auto& last = before->state;
    begun.index = last.index + 1;
    if (!ends_a_step(last.acts)) begun.increment = last.increment + 1;
    const double each = (MPI_Wtime() - began_) / static_cast<double>(last.index);
    left = each * static_cast<double>(states_ - last.index);
  }
  print_state(acts, begun.index - 1, states_, left, context_.log);
  return begun;
}

analysis::Observer Report::LoadSteps::observer(const Begun& begun)
{
  return [this, acts = begun.acts](int step, double change, const qp::Progress& p) { run_.history_.note(acts, step, change, p); };
}

// Whether the fields of the state are to be written.
bool Report::LoadSteps::is_due(const Begun& begun, const post::Verdict& verdict) const
{
  return ends_a_step(begun.acts) || !verdict.solved() || begun.increment % deck_.output.every == 0;
}

bool Report::LoadSteps::gave_up(const analysis::StepState& state)
{
  context_.log.end_progress();
  run_.end_stage("solve", "solve");
  if (!state.solved.gave_up) return false;
  if (!approach_.takes_bodies_whole()) run_.sizes_as_cut_ = output::sizes_of(state.problem.system(), context_.comm);
  return true;
}

auto Report::LoadSteps::write(const Begun& begun, const analysis::StepState& state, const post::Probes& probes,
                              const post::Results& results, const std::optional<Written>& before) -> Written
{
  const auto& comm = context_.comm;
  const auto& model = assembly_.model();
  const output::EvaluatedState found{model.decomposition(), assembly_.interface(), state, probes, results};
  const bool first = !before;
  auto summary = output::summarise(model, found, comm);
  summary.version = MORTISE_VERSION;
  summary.algorithm = qp::solver_kind(approach_.algorithm).name;
  if (approach_.takes_bodies_whole() && run_.sizes_as_cut_.subdomains > 0) output::copy_sizes(run_.sizes_as_cut_, summary);
  if (first) summary.hessian_multiplications += approach_.spent;
  output::accumulate_steps(begun.acts, before ? before->summary : io::Summary{}, summary);
  run_.warnings_.add(analysis::check_results(model, state, results, comm));
  {
    const auto scope = context_.timers.scope("output");
    files_.write(found, is_due(begun, results.verdict), begun.index == states_ || !results.verdict.solved(), comm);
    probe_files_.write(model.decomposition().catalogue, begun.acts, probes, results.fields.interior.sampled, summary.probes,
                       comm);
    collectively(comm, [&] {
      if (!comm.root()) return;
      io::write_text(deck_.output.directory + "/history.csv", run_.history_.text());
      if (first) io::write_text(deck_.output.directory + "/deck.yaml", io::written_mark() + "\n" + write_deck(deck_));
    });
  }
  run_.state_is_written_ = true;
  run_.tell_stage("output", "output");  // does not end the run: a state that is written is to be kept for --resume
  return {begun, std::move(summary), results.forces.balance, results.verdict};
}

void Report::LoadSteps::keep(const Written& written, const analysis::StepState& state) const
{
  if (written.state.index < states_) restart_.keep(written.state.index, approach_, state);
}

analysis::Outcome Report::LoadSteps::failed(const Begun& begun, const analysis::LoadStepSolver& solver,
                                            std::optional<Written>& before) const
{
  try {
    return analysis::failed(approach_, solver.applications(), context_.comm);
  } catch (const Error& error) {
    fail(error, begun, before);
  }
}

void Report::LoadSteps::fail(const Error& error, const Begun& begun, std::optional<Written>& before) const
{
  context_.log.end_progress();
  if (!before) throw error;
  before->summary.converged = false;
  before->summary.exit_status = static_cast<int>(error.status());
  try {
    write_summary(before->summary, true);
  } catch (const Error&) {  // the one on the disk says that the run is not finished
  }
  throw Error(error.status(), fmt::format("step {}, time {:.4g}: {}\nThe results of the states before are written.",
                                          begun.acts.step, begun.acts.time, error.what()));
}

bool Report::LoadSteps::goes_on(Written& last) const
{
  if (last.state.index == states_) return false;
  if (!last.verdict.solved()) {
    context_.log.line("Step {} did not converge; the {} states after it are not solved.", last.state.acts.step,
                      states_ - last.state.index);
    return false;
  }
  print_step(last.summary, context_.log);
  write_summary(last.summary, false);
  return true;
}

void Report::LoadSteps::write_summary(io::Summary& summary, bool finished) const
{
  const auto& comm = context_.comm;
  summary.finished = finished;
  summary.warnings = run_.warnings_.all();
  summary.time["total"] = comm.max(MPI_Wtime() - run_.start_);
  summary.peak_memory_bytes = comm.sum(static_cast<double>(peak_memory()));
  collectively(comm, [&] {
    if (comm.root()) io::write_text(deck_.output.directory + "/summary.json", io::to_json(summary));
  });
}

ExitStatus Report::LoadSteps::end(Written& last) const
{
  auto& [comm, log, timers] = context_;
  auto& summary = last.summary;
  output::note_communication(timers, traffic() - run_.before_all_, comm, summary);
  const auto spreads = timers.spread(comm);
  for (const auto& spread : spreads) summary.time[spread.stage] = spread.max;
  write_summary(summary, true);
  print_results(last.verdict, last.balance, summary, log);
  print_probes(summary, log);
  log.line("  time and memory     {:.2f} s, {:.2f} GB; results in {}", summary.time["total"], summary.peak_memory_bytes / 1e9,
           deck_.output.directory);
  print_communication(summary, log);
  print_times(spreads, log);
  print_warnings(run_.warnings_, log);
  if (last.verdict.solved()) restart_.remove();
  return last.verdict.status;
}

}  // namespace mortise
