#include "run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "constraint/supports.hpp"
#include "contact/mortar.hpp"
#include "fem/stiffness.hpp"
#include "feti/dual_problem.hpp"
#include "friction/friction.hpp"
#include "io/files.hpp"
#include "memory.hpp"
#include "model.hpp"
#include "partition/decompose.hpp"
#include "report.hpp"

namespace mortise {

namespace {

// Of the estimated discretization error, at which the solver stops where the tolerance is auto.
constexpr double algebraic_part = 0.1;

void print_header(const Deck& deck, const partition::Decomposition& decomposition, const Context& context)
{
  const auto& catalogue = decomposition.catalogue;
  context.log.line("Mortise {}: {}", MORTISE_VERSION, deck.title.empty() ? "(no title)" : deck.title);
  context.log.line("  {} bodies, {} nodes, {} cells, {} unknowns; {} subdomains on {} ranks; {} contacts",
                   catalogue.bodies.size(), catalogue.node_count, catalogue.cell_count,
                   catalogue.node_count * catalogue.dimension, decomposition.subdomain_count(), context.comm.size(),
                   deck.contacts.size());
}

// --check: what would be solved.
void print_check(const partition::Decomposition& decomposition, const std::vector<constraint::Held>& held,
                 const constraint::Contacts& contacts, const Memory& memory, const Deck& deck, const Context& context)
{
  const auto& comm = context.comm;
  long long unknowns = 0;
  for (const auto& subdomain : decomposition.subdomains)
    unknowns += static_cast<long long>(subdomain.mesh.node_count()) * deck.dimension();
  const auto total = comm.sum(unknowns);
  context.log.line("  {} unknowns in the subdomains, {} held components, {} contact points with {} rows", total,
                   comm.sum(static_cast<long long>(held.size())), comm.sum(static_cast<long long>(contacts.points.size())),
                   comm.sum(static_cast<long long>(contacts.rows.size())));
  std::vector<double> points(deck.contacts.size(), 0.0);
  for (const auto& point : contacts.points) points[static_cast<std::size_t>(point.contact)] += 1;
  comm.sum_in_place(points);
  for (std::size_t c = 0; c < points.size(); ++c) context.log.line("  contact {}: {} points", deck.contacts[c].name, points[c]);
  context.log.line("  memory expected: about {:.1f} GB, {:.1f} GB of it for the factors of the subdomains", memory.total / 1e9,
                   memory.factors / 1e9);
}

// A contact that finds no partner does nothing: the bodies would pass through each other unnoticed.
void warn_of_idle_contacts(const constraint::Contacts& contacts, const Deck& deck, const Context& context)
{
  std::vector<double> points(deck.contacts.size(), 0.0);
  for (const auto& point : contacts.points) points[static_cast<std::size_t>(point.contact)] += 1;
  context.comm.sum_in_place(points);
  for (std::size_t c = 0; c < points.size(); ++c)
    if (points[c] == 0)
      context.log.warning(
          "contact {} has no point: its surfaces do not face each other within the search distance, or share less than a "
          "twentieth of "
          "a cell, and nothing keeps them apart; look at the names, set a larger search_distance, or refine the secondary side",
          deck.contacts[c].name);
}

// Factorizes every subdomain that is not a copy of an earlier one.
feti::Floating float_subdomains(const Deck& deck, const partition::Decomposition& decomposition,
                                const std::vector<partition::CopyOf>& copies, std::vector<SparseMatrix> stiffness,
                                std::vector<Eigen::VectorXd> load, std::vector<std::vector<double>> nodal_stiffness,
                                const Communicator& comm)
{
  feti::Floating floating{{}, std::move(load), std::move(nodal_stiffness), deck.kinematics};
  collectively(comm, [&] {
    for (std::size_t s = 0; s < copies.size(); ++s) {
      const auto& [original, rotation] = copies[s];
      if (original != s) {
        const auto& shared = floating.subdomains[original];
        floating.subdomains.push_back(rotation ? std::make_shared<feti::TurnedSubdomain>(shared, *rotation, deck.dimension())
                                               : shared);
        continue;
      }
      const auto& points = decomposition.subdomains[s].mesh.points;
      floating.subdomains.push_back(
          std::make_shared<feti::ElasticSubdomain>(std::move(stiffness[s]), fem::rigid_motions(points, deck.kinematics), points,
                                                   deck.dimension(), deck.solver.subdomains.factorization));
    }
  });
  return floating;
}

// The rows of history.csv and the moving line.
class History {
 public:
  History(const Deck& deck, const Context& context) : deck_(deck), context_(context) {}

  void note(int step, double change, const qp::Progress& p)
  {
    if (p.what == "inner") {
      const auto& options = deck_.solver.programme;
      const auto measures = options.algorithm == "smalse"
                                ? fmt::format("gradient {:.1e}, equality {:.1e}", p.projected_gradient, p.equality)
                                : fmt::format("residual {:.1e}", std::max(p.projected_gradient, p.equality));
      context_.log.progress("  {}outer {}, {} products, {} (tolerance {}); {} open, {} slipping on rank 0",
                            step > 1 ? fmt::format("friction step {}, ", step) : "", p.outer, p.multiplications, measures,
                            options.tolerance.value ? fmt::format("{:.1e}", *options.tolerance.value) : "auto", p.active.bounds,
                            p.active.discs);
      return;
    }
    const auto bounds = context_.comm.sum(p.active.bounds), discs = context_.comm.sum(p.active.discs);
    text_ += fmt::format("{},{},{},{},{},{:.6e},{:.6e},{:.6e},{:.3e},{},{}\n", p.what, step, p.outer, p.multiplications,
                         p.preconditionings, p.projected_gradient, p.equality, change, p.precision, bounds, discs);
  }
  const std::string& text() const { return text_; }

 private:
  const Deck& deck_;
  const Context& context_;
  std::string text_ =
      "stage,friction_step,outer_iteration,hessian_multiplications,preconditionings,projected_gradient,equality,slip_bound_"
      "change,precision,open,"
      "slipping\n";
};

}  // namespace

ExitStatus run(const Deck& deck, deck::Document& document, const CommandLine& command_line, const Context& context)
{
  auto& [comm, log, timers] = context;
  const double start = MPI_Wtime();
  const auto decomposition = partition::decompose(deck.mesh, deck.decomposition, deck.dimension(), context);
  check_names(deck, document, decomposition.catalogue);
  document.check();
  print_header(deck, decomposition, context);
  const auto stage = [&](const char* what, const char* name) {
    log.line("  {:<22} {:8.2f} s", what, comm.max(timers.seconds(name)));
  };
  stage("mesh", "mesh");
  stage("partition", "partition");
  if (!command_line.check) io::prepare_directory(deck.output.directory, comm);

  const Model model(deck, decomposition);
  model.require_fit(document, comm);
  constraint::Constraints constraints;
  std::vector<contact::Pair> pairs;
  {
    const auto scope = timers.scope("contact");
    constraints.held = constraint::hold(model.supports(), model.support_nodes(comm), deck.dimension(), comm);
    pairs = model.contact_pairs();
    constraints.contacts = contact::discretize(pairs, constraints.held, deck.kinematics, comm);
  }
  stage("supports and contact", "contact");
  warn_of_idle_contacts(constraints.contacts, deck, context);
  const auto copies = model.congruent();
  const auto memory = foresee_memory(deck, decomposition, model, copies, comm);
  if (command_line.check) print_check(decomposition, constraints.held, constraints.contacts, memory, deck, context);
  require(memory, deck, decomposition);
  if (command_line.check) return ExitStatus::solved;

  std::vector<SparseMatrix> stiffness;
  std::vector<Eigen::VectorXd> load;
  {
    const auto scope = timers.scope("assembly");
    collectively(comm, [&] { stiffness = model.stiffness(copies); });
    load = model.loads(comm);
  }
  stage("assembly", "assembly");
  std::vector<std::vector<double>> nodal_stiffness;
  for (std::size_t s = 0; s < copies.size(); ++s)
    nodal_stiffness.push_back(copies[s].original == s ? feti::nodal_stiffness(stiffness[s], deck.dimension())
                                                      : nodal_stiffness[copies[s].original]);
  const partition::NodeDirectory directory(decomposition, nodal_stiffness, comm);
  const auto interface = partition::find_interface(decomposition, directory, comm);
  feti::Floating floating;
  {
    const auto scope = timers.scope("factorization");
    floating =
        float_subdomains(deck, decomposition, copies, std::move(stiffness), std::move(load), std::move(nodal_stiffness), comm);
  }
  stage("factorization", "factorization");
  long long originals = 0;
  for (std::size_t s = 0; s < copies.size(); ++s) originals += copies[s].original == s ? 1 : 0;
  originals = comm.sum(originals);
  if (originals < decomposition.subdomain_count())
    log.line("  {} subdomains are copies of {} others and share their factors", decomposition.subdomain_count() - originals,
             originals);

  History history(deck, context);
  std::unique_ptr<feti::DualProblem> problem;
  std::unique_ptr<friction::Result> solved;
  {
    const auto scope = timers.scope("solve");
    problem = std::make_unique<feti::DualProblem>(decomposition, directory, interface, constraints, floating,
                                                  deck.solver.subdomains, context);
    log.line("  dual problem: {} multipliers, {} kernel dimensions", problem->dual_unknowns(), problem->kernel_dimension());
    const auto allowed_error = [&](const Vector& lambda, const Eigen::VectorXd& nu) {
      const auto estimating = timers.scope("error estimate");
      return algebraic_part *
             discretization_error(deck, decomposition, model, interface, problem->displacement(lambda, nu), comm);
    };
    solved = std::make_unique<friction::Result>(
        friction::solve(*problem, model.friction_laws(), deck.friction_loop, deck.solver.programme, allowed_error,
                        [&](int step, double change, const qp::Progress& p) { history.note(step, change, p); }));
  }
  log.end_progress();
  stage("solve", "solve");

  Results results = evaluate(deck, decomposition, model, interface, pairs, *problem, floating, *solved, context);
  {
    const auto scope = timers.scope("output");
    write_fields(deck, decomposition, pairs, interface, *problem, *solved, results, comm);
    collectively(comm, [&] {
      if (!comm.root()) return;
      io::write_text(deck.output.directory + "/history.csv", history.text());
      io::write_text(deck.output.directory + "/deck.yaml", write_deck(deck));
    });
  }
  stage("output", "output");
  const auto spreads = timers.spread(comm);
  for (const auto& spread : spreads) results.summary.time[spread.stage] = spread.max;
  results.summary.time["total"] = comm.max(MPI_Wtime() - start);
  results.summary.peak_memory_bytes = comm.sum(static_cast<double>(peak_memory()));
  collectively(comm, [&] {
    if (comm.root()) io::write_text(deck.output.directory + "/summary.json", io::to_json(results.summary));
  });
  print(results, context);
  log.line("  time and memory     {:.2f} s, {:.2f} GB; results in {}", results.summary.time["total"],
           results.summary.peak_memory_bytes / 1e9, deck.output.directory);
  log.line("  seconds on the ranks       min     mean      max");
  for (const auto& spread : spreads)
    log.line("    {:<18} {:8.2f} {:8.2f} {:8.2f}", spread.stage, spread.min, spread.mean, spread.max);
  return results.summary.converged ? ExitStatus::solved : ExitStatus::not_converged;
}

}  // namespace mortise
