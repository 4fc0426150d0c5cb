#include "run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <new>
#include <optional>
#include <utility>

#include "auto_contacts.hpp"
#include "base/interruption.hpp"
#include "base/traffic.hpp"
#include "base/traffic_counted.hpp"
#include "effort.hpp"
#include "initial_gaps.hpp"
#include "io/files.hpp"
#include "io/output_directory.hpp"
#include "listing.hpp"
#include "memory.hpp"
#include "partition/decompose.hpp"
#include "partition/whole_bodies.hpp"
#include "patterns.hpp"
#include "report.hpp"
#include "simulation.hpp"
#include "untouched.hpp"
#include "warnings.hpp"

namespace mortise {

namespace {

void print_header(const Deck& deck, const partition::Decomposition& decomposition, const Context& context)
{
  const auto& catalogue = decomposition.catalogue;
  context.log.line("Mortise {}: {}", MORTISE_VERSION, deck.title.empty() ? "(no title)" : deck.title);
  context.log.line("  {} bodies, {} nodes, {} cells, {} unknowns; {} subdomains{} on {} ranks; {} contacts",
                   catalogue.bodies.size(), catalogue.node_count, catalogue.cell_count,
                   catalogue.node_count * catalogue.dimension, decomposition.subdomain_count(),
                   decomposition.clustered() ? fmt::format(" in {} clusters", decomposition.cluster_count()) : "",
                   context.comm.size(), deck.contacts.size());
}

// --check: what would be solved.
void print_check(const partition::Decomposition& decomposition, const constraint::Constraints& constraints, const Memory& memory,
                 const Deck& deck, const Context& context)
{
  const auto& comm = context.comm;
  const auto& contacts = constraints.contacts;
  long long unknowns = 0;
  for (const auto& subdomain : decomposition.subdomains)
    unknowns += static_cast<long long>(subdomain.mesh.node_count()) * deck.dimension();
  const auto total = comm.sum(unknowns);
  context.log.line("  {} unknowns in the subdomains, {} held components, {} contact points with {} rows", total,
                   comm.sum(static_cast<long long>(constraints.held.size() + constraints.inclined.size())),
                   comm.sum(static_cast<long long>(contacts.points.size())),
                   comm.sum(static_cast<long long>(contacts.rows.size())));
  std::vector<double> points(deck.contacts.size(), 0.0);
  for (const auto& point : contacts.points) points[static_cast<std::size_t>(point.contact)] += 1;
  comm.sum_in_place(points);
  for (std::size_t c = 0; c < points.size(); ++c) context.log.line("  contact {}: {} points", deck.contacts[c].name, points[c]);
  context.log.line("  memory expected: about {:.1f} GB, {:.1f} GB of it for the factors of the subdomains", memory.total / 1e9,
                   memory.factors / 1e9);
}

// In a table: nothing where there is no number yet.
std::string number(double x, int digits = 6)
{
  return std::isfinite(x) ? fmt::format("{:.{}e}", x, digits) : "";
}

// The rows of history.csv and the moving line.
class History {
 public:
  History(const Deck& deck, const Context& context) : deck_(deck), context_(context) {}

  void note(const LoadState& state, int step, double change, const qp::Progress& p)
  {
    if (p.what != "inner" || ++inner_ % 4 == 0) end_if_told(context_.comm);  // asking takes time where ranks share a core
    if (p.what == "inner") {
      const auto& options = deck_.solver.programme;
      const auto measures = options.algorithm == "smalse"
                                ? fmt::format("gradient {:.1e}, equality {:.1e}", p.projected_gradient, p.equality)
                                : fmt::format("residual {:.1e}", std::max(p.projected_gradient, p.equality));
      context_.log.progress("  {}outer {}, {} products, {} (tolerance {}){}",
                            step > 1 ? fmt::format("friction step {}, ", step) : "", p.outer, p.multiplications, measures,
                            options.tolerance.value ? fmt::format("{:.1e}", *options.tolerance.value) : "auto", active_);
      return;
    }
    const auto bounds = context_.comm.sum(p.active.bounds), discs = context_.comm.sum(p.active.discs);
    text_ += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.what, step, p.outer, p.multiplications,
                         p.preconditionings, number(p.projected_gradient), number(p.equality), number(change),
                         number(p.precision, 3), bounds, discs, state.time, number(p.energy, 12), number(p.error, 3));
    active_ = fmt::format("; {} open, {} slipping", bounds, discs);
  }
  const std::string& text() const { return text_; }

 private:
  const Deck& deck_;
  const Context& context_;
  long long inner_ = 0;  // calls within outer iterations, the same on all ranks
  std::string active_;   // contact points of all ranks at the end of the last outer iteration
  std::string text_ =
      "stage,friction_step,outer_iteration,hessian_multiplications,preconditionings,projected_gradient,equality,slip_bound_"
      "change,precision,open,"
      "slipping,time,dual_energy,error\n";
};

void print_copies(const std::vector<partition::CopyOf>& copies, const partition::Decomposition& decomposition,
                  const Context& context)
{
  long long originals = 0;
  for (std::size_t s = 0; s < copies.size(); ++s) originals += copies[s].original == s ? 1 : 0;
  originals = context.comm.sum(originals);
  if (originals < decomposition.subdomain_count())
    context.log.line("  {} subdomains are copies of {} others and share their factors",
                     decomposition.subdomain_count() - originals, originals);
}

// Says which state is being solved, where there are several.
void print_state(const LoadState& state, std::size_t index, const std::vector<LoadState>& states, Log& log)
{
  if (!state.step.empty()) log.line("Step {}, time {:.4g} ({} of {} states)", state.step, state.time, index + 1, states.size());
}

// The summary of the states so far, of which `results` is the last.
void add_up(const LoadState& state, const io::Summary& before, Results& results)
{
  auto& summary = results.summary;
  summary.steps = before.steps;
  if (state.step.empty()) return;
  io::Summary::Step step;
  static_cast<io::StateSummary&>(step) = summary;
  step.name = state.step;
  step.time = state.time;
  summary.steps.push_back(std::move(step));
  summary.friction_steps += before.friction_steps;
  summary.outer_iterations += before.outer_iterations;
  summary.hessian_multiplications += before.hessian_multiplications;
}

io::Summary::Spread over_ranks(const Traffic& mine, const Communicator& comm)
{
  io::Summary::Spread result;
  const auto spread = [&](long long x, double& largest, double& mean) {
    largest = static_cast<double>(comm.max(x));
    mean = static_cast<double>(comm.sum(x)) / comm.size();
  };
  spread(mine.messages, result.largest.messages, result.mean.messages);
  spread(mine.bytes, result.largest.bytes, result.mean.bytes);
  spread(mine.collectives, result.largest.collectives, result.mean.collectives);
  spread(mine.collective_bytes, result.largest.collective_bytes, result.mean.collective_bytes);
  return result;
}

// What is neither solution nor output sets up. Nothing in a build that does not count.
void note_communication(const Timers& timers, const Traffic& total, const Communicator& comm, io::Summary& summary)
{
  if (!traffic_is_counted()) return;
  const Traffic solve = timers.traffic("solve");
  summary.communication["total"] = over_ranks(total, comm);
  summary.communication["set_up"] = over_ranks(total - solve - timers.traffic("output"), comm);
  summary.communication["solve"] = over_ranks(solve, comm);
  summary.communication["multiplication"] = over_ranks(timers.traffic("multiplication"), comm);
}

std::string bytes(double count)
{
  const char* unit = "B";
  for (const char* larger : {"kB", "MB", "GB"})
    if (count >= 1000) {
      count /= 1000;
      unit = larger;
    }
  return fmt::format("{:.3g} {}", count, unit);
}

// Of the rank that sends most; nothing where there is one rank, or nothing was counted.
void print_communication(const io::Summary& summary, Log& log)
{
  if (summary.ranks == 1 || summary.communication.empty()) return;
  const auto& [total, mean] = summary.communication.at("total");
  const auto& product = summary.communication.at("multiplication").largest;
  const double products = std::max(summary.hessian_multiplications, 1);
  log.line("  sent by a rank      {} in {:.0f} messages, {} in {:.0f} collective calls; a product with F: {} in {:.3g} messages",
           bytes(total.bytes), total.messages, bytes(total.collective_bytes), total.collectives, bytes(product.bytes / products),
           product.messages / products);
}

// The stages of a run, which end with a line and its time.
class Stages {
 public:
  explicit Stages(const Context& context) : context_(context) {}

  // The time since it was last asked for.
  void end(const char* what, const char* name)
  {
    const double seconds = context_.timers.seconds(name);
    end_if_told(context_.comm);
    context_.log.line("  {:<22} {:8.2f} s", what, context_.comm.max(seconds - before_[name]));
    before_[name] = seconds;
  }

 private:
  const Context& context_;
  std::map<std::string, double> before_;
};

// Of the problem that is being solved.
io::Summary sizes(const partition::Decomposition& decomposition, const feti::DualProblem& problem, const Communicator& comm)
{
  io::Summary result;
  for (const auto& subdomain : decomposition.subdomains)
    result.primal_unknowns += static_cast<Global>(subdomain.mesh.node_count()) * problem.dimension();
  result.primal_unknowns = comm.sum(result.primal_unknowns);
  result.dual_unknowns = problem.dual_unknowns();
  result.subdomains = decomposition.subdomain_count();
  result.clusters = decomposition.clustered() ? decomposition.cluster_count() : 0;
  result.kernel_dimension = problem.kernel_dimension();
  return result;
}

void copy_sizes(const io::Summary& from, io::Summary& to)
{
  to.primal_unknowns = from.primal_unknowns;
  to.dual_unknowns = from.dual_unknowns;
  to.subdomains = from.subdomains;
  to.clusters = from.clusters;
  to.kernel_dimension = from.kernel_dimension;
}

// Where products with F find no end, bodies are taken whole and the problem solved directly; where rounding spoils that (cells a
// thousand times as long as thick), the first way is gone to its end.
enum class Attempt { first, direct, last };
constexpr int products_to_show_it = 40;  // that a direct solution is one

// What a direct solution may fall on where products with F do not: rounding, memory.
bool may_be_tried_again(const Error& error)
{
  return error.status() == ExitStatus::bad_input || error.status() == ExitStatus::not_converged ||
         error.cause() == Error::Cause::memory;
}

// A run on its way: what all attempts share.
struct Way {
  const Deck& given;
  deck::Document& document;
  const CommandLine& command_line;
  const Context& context;
  Deck deck;
  Stages& stages;
  History history{deck, context};
  Warnings warnings{};
  Attempt attempt = Attempt::first;
  int spent = 0;        // products of the attempts before this one
  io::Summary sizes{};  // of the problem as the deck cuts it, from the first attempt
  double start = MPI_Wtime();
  Traffic before_all = traffic();
};

// All load states on one decomposition; nothing if the solver gave up, and bodies are to be taken whole.
std::optional<ExitStatus> carry_out(Way& way, const partition::Decomposition& decomposition)
{
  auto& deck = way.deck;
  auto& [comm, log, timers] = way.context;
  const auto& context = way.context;
  auto& stages = way.stages;
  auto& warnings = way.warnings;
  const bool check = way.command_line.check;
  const Model model(deck, decomposition);
  model.require_fit(way.document, comm);
  const auto states = load_states(deck);
  Simulation simulation(deck, decomposition, model, states.front(), way.spent, context);
  const auto& constraints = simulation.constraints();
  if (way.attempt == Attempt::first) {
    stages.end("supports and contact", "contact");
    for (auto& warning : check_model(deck, decomposition, model, simulation, comm)) warnings.tell(std::move(warning), log);
    for (auto& warning : report_initial_gaps(simulation.initial_gaps(), deck, check, log)) warnings.tell(std::move(warning), log);
    judge_untouched(deck, decomposition, model, states.front(), simulation.pairs(), constraints.contacts, context, warnings);
  }
  const auto copies = model.congruent();
  const auto memory = foresee_memory(deck, decomposition, model, copies, comm);
  if (check) print_check(decomposition, constraints, memory, deck, context);
  require(memory, deck, decomposition);
  if (check) return ExitStatus::solved;

  simulation.factorize(copies);
  stages.end("assembly", "assembly");
  stages.end("factorization", "factorization");
  print_copies(copies, decomposition, context);
  if (way.attempt == Attempt::first && deck.solver.programme.algorithm == "auto")
    simulation.lose_patience_after(
        patience_with_products(effort_of_direct(decomposition, simulation.floating(), constraints, comm), comm));
  else if (way.attempt == Attempt::direct)
    simulation.lose_patience_after(products_to_show_it);
  else if (deck.solver.programme.algorithm == "direct")
    require_room_for_direct(effort_of_direct(decomposition, simulation.floating(), constraints, comm), comm);

  FieldFiles files(deck, decomposition);
  Results results;
  const auto write_summary = [&](bool finished) {
    results.summary.finished = finished;
    results.summary.warnings = warnings.all();
    results.summary.time["total"] = comm.max(MPI_Wtime() - way.start);
    results.summary.peak_memory_bytes = comm.sum(static_cast<double>(peak_memory()));
    collectively(comm, [&] {
      if (comm.root()) io::write_text(deck.output.directory + "/summary.json", io::to_json(results.summary));
    });
  };
  // `results` are those of the last state whose files are written: what the summary tells is on the disk. False if the solver
  // gave up.
  const auto solve = [&](const LoadState& state, bool last) {
    simulation.solve(state, [&](int step, double change, const qp::Progress& p) { way.history.note(state, step, change, p); });
    log.end_progress();
    stages.end("solve", "solve");
    if (simulation.solved().gave_up) return false;
    Results found = evaluate(deck, decomposition, model, simulation, context);
    if (found.verdict.status == ExitStatus::no_equilibrium) throw Error(found.verdict.status, found.verdict.reason);
    found.summary.algorithm = deck.solver.programme.algorithm == "auto" ? "face_newton" : deck.solver.programme.algorithm;
    if (way.attempt == Attempt::direct) copy_sizes(way.sizes, found.summary);
    if (results.summary.version.empty()) found.summary.hessian_multiplications += way.spent;
    add_up(state, results.summary, found);
    warnings.add(check_results(deck, decomposition, model, simulation, found, comm));
    {
      const auto scope = timers.scope("output");
      files.write(simulation, found, state.time, last || !found.summary.converged, comm);
      collectively(comm, [&] {
        if (!comm.root()) return;
        io::write_text(deck.output.directory + "/history.csv", way.history.text());
        if (results.summary.version.empty())  // the first state
          io::write_text(deck.output.directory + "/deck.yaml", io::written_mark() + "\n" + write_deck(way.given));
      });
    }
    results = std::move(found);
    stages.end("output", "output");
    return true;
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto& state = states[i];
    const bool last = i + 1 == states.size();
    print_state(state, i, states, log);
    try {
      if (!solve(state, last)) {
        way.spent = simulation.multiplications();
        if (way.attempt == Attempt::first) way.sizes = sizes(decomposition, simulation.problem(), comm);
        return {};
      }
    } catch (const std::bad_alloc&) {
      way.spent = simulation.multiplications();
      throw;
    } catch (const Error& error) {
      log.end_progress();
      way.spent = simulation.multiplications();
      if (i == 0 || (way.attempt == Attempt::direct && may_be_tried_again(error))) throw;
      results.summary.converged = false;
      results.summary.exit_status = static_cast<int>(error.status());
      try {
        write_summary(true);
      } catch (const Error&) {  // the one on the disk says that the run is not finished
      }
      throw Error(error.status(), fmt::format("step {}, time {:.4g}: {}\nThe results of the states before are written.",
                                              state.step, state.time, error.what()));
    }
    if (last) break;
    if (!results.summary.converged) {
      log.line("Step {} did not converge; the {} states after it are not solved.", state.step, states.size() - i - 1);
      break;
    }
    print_step(results, context);
    write_summary(false);
    simulation.settle(results.displacement);
  }
  note_communication(timers, traffic() - way.before_all, comm, results.summary);
  const auto spreads = timers.spread(comm);
  for (const auto& spread : spreads) results.summary.time[spread.stage] = spread.max;
  write_summary(true);
  print(results, context);
  log.line("  time and memory     {:.2f} s, {:.2f} GB; results in {}", results.summary.time["total"],
           results.summary.peak_memory_bytes / 1e9, deck.output.directory);
  print_communication(results.summary, log);
  log.line("  seconds on the ranks       min     mean      max");
  for (const auto& spread : spreads)
    log.line("    {:<18} {:8.2f} {:8.2f} {:8.2f}", spread.stage, spread.min, spread.mean, spread.max);
  print(warnings, log);
  return results.verdict.status;
}

}  // namespace

ExitStatus run(const Deck& given, deck::Document& document, const CommandLine& command_line, const Context& context)
{
  auto& [comm, log, timers] = context;
  const double start = MPI_Wtime();
  const Traffic before_all = traffic();
  Deck deck = given;
  std::optional<io::OutputDirectory> output;
  if (!command_line.check) output.emplace(deck.output.directory, std::vector{document.file(), deck.mesh.file}, comm);
  auto decomposition = partition::decompose(deck.mesh, deck.decomposition, deck.dimension(), context);
  if (deck.solver.programme.algorithm == "direct") decomposition = partition::whole_bodies(decomposition, comm);
  if (command_line.check) print_listing(decomposition, deck.kinematics, context);
  resolve_patterns(deck, document, decomposition, comm);
  check_names(deck, document, decomposition.catalogue);
  document.check();
  const auto meetings = resolve_auto(deck, document, decomposition, context);
  document.check();
  print_header(deck, decomposition, context);
  Stages stages(context);
  stages.end("mesh", "mesh");
  stages.end("partition", "partition");
  print_meetings(meetings, given, deck, decomposition, command_line.check, context);
  if (output) output->clear();

  Way way{given, document, command_line, context, std::move(deck), stages};
  way.start = start;
  way.before_all = before_all;
  if (const auto status = carry_out(way, decomposition)) return *status;
  log.line("  {} products with F, and no end near: a direct solution, with every body whole, costs as much", way.spent);
  way.attempt = Attempt::direct;
  way.deck.solver.programme.algorithm = "direct";
  const char* why = "does not settle, or rounding spoils it";
  try {
    if (const auto status = carry_out(way, partition::whole_bodies(decomposition, comm))) return *status;
  } catch (const Error& error) {
    if (!may_be_tried_again(error)) throw;
    if (error.cause() == Error::Cause::memory) why = "finds no room in memory";
  } catch (const std::bad_alloc&) {
    if (comm.size() > 1) throw;  // the other ranks know nothing of it
    why = "finds no room in memory";
  }
  log.end_progress();
  log.line("  the direct solution {}: back to products with F", why);
  way.attempt = Attempt::last;
  way.deck.solver.programme.algorithm = "face_newton";
  return carry_out(way, decomposition).value();
}

}  // namespace mortise
