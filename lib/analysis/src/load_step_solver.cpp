#include "analysis/load_step_solver.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/symmetric_nodes.hpp"
#include "base/error.hpp"
#include "constraint/right_hand_sides.hpp"
#include "contact/sliding_surfaces.hpp"
#include "feti/facet_support.hpp"
#include "friction/law.hpp"
#include "post/compatibility.hpp"
#include "same_nodes.hpp"

namespace mortise::analysis {

namespace {

// Of the estimated discretization error, at which the solver stops where the tolerance is auto.
constexpr double algebraic_part = 0.1;
// Of the size of the solution, whatever the discretization error is estimated to be.
constexpr double smallest_part = 1e-6, largest_part = 0.05;
// Of the norm with what springs store, below which bodies that hang on them are not strained.
constexpr double strained = 1e-3;

// Of the largest force of the states before: balances of forces are relative to so much at least.
constexpr double part_to_balance = 1e-3;

// The solution of one problem as a start for another one of the same assembly, where other components are prescribed.
qp::Solution carry_solution(const feti::DualProblem& from, const qp::Solution& solution, const feti::DualProblem& to)
{
  const Eigen::VectorXd before = from.forces(solution.x);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(to.jump().rows()->getNodeNumElements()));
  Eigen::VectorXd gaps = forces;
  const auto &old_ranges = from.jump().ranges(), &ranges = to.jump().ranges();
  const auto &old = from.constraints(), &now = to.constraints();
  forces.head(ranges.dirichlet) = before.head(old_ranges.dirichlet);
  std::map<std::pair<Global, int>, Local> prescribed;
  for (std::size_t i = 0; i < old.prescribed.size(); ++i)
    prescribed[{old.prescribed[i].node, old.prescribed[i].component}] = old_ranges.dirichlet + static_cast<Local>(i);
  for (std::size_t i = 0; i < now.prescribed.size(); ++i)
    if (const auto found = prescribed.find({now.prescribed[i].node, now.prescribed[i].component}); found != prescribed.end())
      forces[ranges.dirichlet + static_cast<Local>(i)] = before[found->second];
  CarriedContact(from, solution).put(to, forces, gaps);
  Eigen::VectorXd nu = Eigen::VectorXd::Zero(to.equality().size());
  const auto common =
      std::min<Eigen::Index>({nu.size(), solution.nu.size(), from.system().kernel_dimension(), to.system().kernel_dimension()});
  nu.head(common) = solution.nu.head(common);
  qp::Solution start(to.multipliers(forces), to.gradient(gaps, nu), nu);
  start.hessian_norm = solution.hessian_norm;
  start.precision = solution.precision;
  start.augmented = solution.augmented;
  return start;
}

post::ElasticBodies elastic_bodies(const Assembly& assembly, std::span<const fem::Constitution> constitution,
                                   const post::SymmetricNodes& symmetric)
{
  return {assembly.decomposition(),
          assembly.interface(),
          assembly.deck().kinematics,
          constitution,
          assembly.model().most_materials(),
          assembly.copies(),
          assembly.system().clusters.subdomains(),
          &symmetric};
}

}  // namespace

namespace {

std::shared_ptr<const post::SymmetricNodes> symmetric_nodes_of(const Rows& rows, const Assembly& assembly,
                                                               const Communicator& comm)
{
  return std::make_shared<const post::SymmetricNodes>(
      find_symmetric_nodes(assembly.model(), rows, assembly.directory(), assembly.interface(), comm));
}

std::vector<constraint::SlidingSurface> sliding_surfaces_of(const Rows& rows, const model::Model& model, const Communicator& comm)
{
  // A support along normals is to its body what an obstacle that it touches everywhere is.
  auto pairs = rows.pairs;
  for (auto& surface : model.surfaces_prescribed_along_normals(rows.acts)) pairs.push_back({{}, std::move(surface), nullptr});
  return contact::sliding_surfaces(pairs, rows.constraints.contacts, model.deck().kinematics, comm);
}

// Shared with the rows.
std::shared_ptr<const constraint::Constraints> constraints_of(const std::shared_ptr<const Rows>& rows)
{
  return {rows, &rows->constraints};
}

// Facets of the mesh stop what slides along itself once friction is used up: a solution, but no equilibrium of the bodies meant.
// Throws Error(no_equilibrium). Collective.
void refuse_support_of_facets(const feti::DualProblem& problem, const Assembly& assembly, const Rows& rows,
                              const feti::DualSolution& found, const std::vector<Eigen::VectorXd>& displacement)
{
  constexpr double inexact = 2e-3;  // of what friction holds
  if (!found.converged) return;     // bounds of an unfinished solution may be much too small
  const auto bounds = friction::slip_bounds(problem, model::friction_laws(assembly.model().contacts()), &found.solution.x);
  const auto& comm = problem.communicator();
  if (!comm.any(!bounds.empty())) return;
  const auto moved = feti::supported_by_facets(problem, assembly.decomposition(), assembly.deck().kinematics,
                                               sliding_surfaces_of(rows, assembly.model(), comm), found.solution.x, displacement,
                                               bounds, inexact);
  if (moved)
    throw Error(ExitStatus::no_equilibrium,
                "no equilibrium: " + *moved + ". Support it, or look at the direction of the loads and at the friction");
}

// The programme of a system of its own, for a solver of that algorithm.
feti::DualProblem make_problem(const Assembly& assembly, const std::shared_ptr<const Rows>& rows,
                               std::vector<Eigen::VectorXd> load, const Approach& approach, const Context& context)
{
  const bool exact = qp::solver_kind(approach.algorithm).exact_products;
  feti::DualProblem problem(
      assembly.decomposition(), assembly.directory(), assembly.interface(), constraints_of(rows), assembly.system(),
      std::move(load), assembly.deck().solver.subdomains, context, sliding_surfaces_of(*rows, assembly.model(), context.comm),
      assembly.model().opposed_loads(rows->acts, context.comm), exact ? feti::Products::exact : feti::Products::rounded);
  context.log.line("  dual problem: {} multipliers, {} kernel dimensions", problem.system().dual_unknowns(),
                   problem.system().kernel_dimension());
  return problem;
}

}  // namespace

StepProblem make_dual_problem(const Assembly& assembly, Rows rows, const Approach& approach, const Context& context)
{
  std::shared_ptr<const Rows> placed;
  std::shared_ptr<const post::SymmetricNodes> symmetric;
  std::vector<Eigen::VectorXd> load;
  {
    const auto scope = context.timers.scope("assembly");
    rows = place(std::move(rows), assembly.model(), assembly.directory(), {}, context.comm);
    symmetric = symmetric_nodes_of(rows, assembly, context.comm);
    load = assembly.loads(rows.acts, context.comm);
    placed = std::make_shared<const Rows>(std::move(rows));
  }
  const auto scope = context.timers.scope("solve");
  auto dual = make_problem(assembly, placed, std::move(load), approach, context);
  return {std::move(placed), std::move(symmetric), std::move(dual), approach.patience};
}

LoadStepSolver::LoadStepSolver(const Assembly& assembly, const StepProblem& first, Approach approach, const Context& context)
    : assembly_(assembly), context_(context), approach_(std::move(approach)), before_(approach_.spent)
{
  const auto scope = context.timers.scope("solve");
  solver_of(first.dual);
}

void LoadStepSolver::drop_solver()
{
  before_ = applications();
  solver_.reset();
}

// What solves problems of this one's system: the same as for the problem before, if it had that system too. Collective.
DualSolver& LoadStepSolver::solver_of(const feti::DualProblem& problem)
{
  if (solver_ && &solver_->system() == &problem.system()) return *solver_;
  drop_solver();
  auto options = assembly_.deck().solver.programme;
  options.algorithm = approach_.algorithm;
  if (auto& most = options.max_multiplications.value) *most -= before_;
  return solver_.emplace(problem.shared_system(), model::friction_laws(assembly_.model().contacts()),
                         assembly_.deck().friction_loop, options);
}

// Of a state and of those before it. Collective.
Magnitudes LoadStepSolver::up_to(const StepState& state) const
{
  const auto scope = context_.timers.scope("solve");
  const auto& comm = context_.comm;
  const auto& problem = state.problem;
  const auto& lambda = state.solved.solution.x;
  Magnitudes result = state.before;
  const auto constitution = assembly_.model().constitution(state.rows->acts);
  result.energy_norm =
      std::max(result.energy_norm, norms(*state.symmetric, problem, constitution, lambda, state.displacement).whole);
  const auto sizes = post::body_sizes(assembly_.decomposition(), assembly_.deck().kinematics, comm);
  result.rounding.take(post::rounding(state.displacement, problem.load(), assembly_.system().nodal_stiffness, problem.dimension(),
                                      *std::max_element(sizes.begin(), sizes.end()), comm));
  double square = 0;
  for (const auto& f : problem.jump().apply_transpose(lambda)) square += f.squaredNorm();
  result.force = std::max(result.force, std::sqrt(comm.sum(square)));
  result.rounding.force = std::max(result.rounding.force, part_to_balance * result.force);
  const bool slides = comm.any(!problem.set().discs().empty());
  if (slides && std::isfinite(state.solved.solution.error)) result.slip_error += state.solved.solution.error;
  return result;
}

// Nothing of the state before stays but what it knows.
StepProblem LoadStepSolver::problem_after(StepState from, const model::LoadState& acts)
{
  const auto magnitudes = up_to(from);
  const auto& comm = context_.comm;
  const auto& model = assembly_.model();
  std::vector<Eigen::VectorXd> load;
  {
    const auto scope = context_.timers.scope("assembly");
    load = assembly_.loads(acts, comm);
  }
  const auto scope = context_.timers.scope("solve");
  Rows rows = *from.rows;
  const Eigen::VectorXd jumps = from.problem.jumps(from.displacement) - from.problem.given_way(from.solved.solution.x);
  const auto& ranges = from.problem.jump().ranges();
  constraint::remember_slip(rows.constraints.contacts,
                            {jumps.data() + ranges.contacts, static_cast<std::size_t>(ranges.extra - ranges.contacts)});

  auto same = with_new_bounds(rows, model, assembly_.directory(), acts, from.shortenings, comm);
  const bool same_sections = rows.constraints.pretension_sections.empty() || acts.locked == rows.acts.locked;
  const bool other_rows = !same;
  if (other_rows) {
    same = place(make_rows(model, acts, from.shortenings, context_), model, assembly_.directory(), from.shortenings, comm);
    carry_slip(rows.constraints.contacts, same->constraints.contacts);
  }
  auto symmetric = symmetric_nodes_of(*same, assembly_, comm);
  auto next = std::make_shared<const Rows>(std::move(*same));
  if (!other_rows && same_sections)
    if (auto dual = from.problem.with_loads(constraints_of(next), load, model.opposed_loads(acts, comm)))
      return {std::move(next),
              std::move(symmetric),
              std::move(*dual),
              from.patience,
              std::move(from.solved.solution),
              magnitudes,
              false};
  drop_solver();  // before there is another system
  auto dual = make_problem(assembly_, next, std::move(load), approach_, context_);
  auto start = carry_solution(from.problem, from.solved.solution, dual);
  return {std::move(next), std::move(symmetric), std::move(dual), from.patience, std::move(start), magnitudes, false};
}

LoadStepSolver::Norms LoadStepSolver::norms(const post::SymmetricNodes& symmetric, const feti::DualProblem& problem,
                                            std::span<const fem::Constitution> constitution, const Vector& lambda,
                                            const std::vector<Eigen::VectorXd>& displacement) const
{
  const auto [error, strain] =
      post::energy_norms(elastic_bodies(assembly_, constitution, symmetric), displacement, context_.comm);
  const auto* springs = problem.system().springs();
  const double whole = std::hypot(strain, springs ? std::sqrt(std::max(springs->stored(lambda), 0.0)) : 0);
  return {error, std::max(strain, strained * whole), whole};
}

// How exactly a state is to be solved. All arguments outlive it.
qp::Goal LoadStepSolver::goal(const StepProblem& problem, std::span<const fem::Constitution> constitution,
                              feti::Displacements& displacements) const
{
  const auto norms_of = [this, &problem, constitution](const Vector& lambda, const std::vector<Eigen::VectorXd>& displacement) {
    return norms(*problem.symmetric, problem.dual, constitution, lambda, displacement);
  };
  const auto norms_at = [this, norms_of, &displacements](const Vector& lambda, const Eigen::VectorXd& nu) {
    const auto estimating = context_.timers.scope("error estimate");
    return norms_of(lambda, displacements.at(lambda, nu));
  };
  const auto allowed_error = [](const Norms& at) {
    return std::clamp(algebraic_part * at.error, smallest_part * at.whole, largest_part * at.size);
  };
  return {.allowed_error = [=](const Vector& lambda, const Eigen::VectorXd& nu) { return allowed_error(norms_at(lambda, nu)); },
          .expected_allowed_error =
              [=, this, &displacements](const Vector& lambda, const Eigen::VectorXd& nu) {
                const auto estimating = context_.timers.scope("error estimate");
                return allowed_error(norms_of(lambda, displacements.at_product(lambda, nu)));
              },
          .incompatibility =
              [this, &problem, &displacements](const Vector& lambda, const Eigen::VectorXd& nu) {
                return post::incompatibility(problem.dual, assembly_.decomposition(), assembly_.interface(),
                                             displacements.at(lambda, nu), nu);
              },
          .energy_norm = [=](const Vector& lambda, const Eigen::VectorXd& nu) { return norms_at(lambda, nu).size; },
          .negligible = problem.before.negligible()};
}

StepState LoadStepSolver::solve(StepProblem problem, const Observer& observer)
{
  const auto constitution = assembly_.model().constitution(problem.rows->acts);
  const auto scope = context_.timers.scope("solve");
  const auto& dual = problem.dual;
  auto& solver = solver_of(dual);
  const auto count_on = [&](int step, double change, qp::Progress progress) {
    progress.applications += before_;
    observer(step, change, progress);
  };
  std::optional<qp::Solution> states;
  if (problem.first && approach_.contact) states = approach_.contact->states_for(dual, context_.comm);
  feti::Displacements displacements(dual, solver.product());
  auto found = solver.solve(dual, problem.start, goal(problem, constitution, displacements), count_on, problem.patience,
                            states ? &*states : nullptr);
  if (found.gave_up) return end(std::move(problem), std::move(found), {});
  if (approach_.kind == Approach::Kind::direct_instead)
    problem.patience.reset();  // what it has solved is not thrown away for a later state
  const auto& x = found.solution.x;
  auto& nu = found.solution.nu;
  nu = dual.least_motion(x, nu, displacements.at(x, nu), problem.before.unfelt());
  auto displacement = displacements.at(x, nu);
  refuse_support_of_facets(dual, assembly_, *problem.rows, found, displacement);
  return end(std::move(problem), std::move(found), std::move(displacement));
}

StepState LoadStepSolver::take_up(StepProblem problem, const Record& record)
{
  const auto scope = context_.timers.scope("solve");
  auto found = solution_of(record, problem.dual, solver_of(problem.dual).product());
  before_ += found.applications;
  auto displacement = problem.dual.displacement(found.solution.x, found.solution.nu);
  return end(std::move(problem), std::move(found), std::move(displacement));
}

// The state, without what only its solution took. No displacement: it gave up.
StepState LoadStepSolver::end(StepProblem problem, feti::DualSolution found, std::vector<Eigen::VectorXd> displacement) const
{
  auto& [rows, symmetric, dual, patience, start, before, first] = problem;
  dual.let_go_of_response();
  auto shortenings = found.gave_up ? std::vector<double>() : dual.shortenings(found.solution.nu);
  return {std::move(rows),
          std::move(symmetric),
          std::move(dual),
          std::move(found),
          std::move(displacement),
          std::move(shortenings),
          patience,
          before,
          first};
}

Outcome LoadStepSolver::given_up(const StepState& state) const
{
  Outcome outcome{.status = {}, .next = approach_.next, .spent = applications()};
  if (state.first)
    outcome.contact =
        std::make_shared<const CarriedContact>(CarriedContact(state.problem, state.solved.solution).spread(context_.comm));
  return outcome;
}

post::Results evaluate(const Assembly& assembly, const StepState& state, const post::Probes& probes, const Context& context)
{
  const auto& comm = context.comm;
  const auto& deck = assembly.deck();
  const auto constitution = assembly.model().constitution(state.rows->acts);
  const post::Equilibrium equilibrium{state.problem,
                                      assembly.system(),
                                      state.rows->pairs,
                                      state.solved,
                                      state.displacement,
                                      deck.supports.size(),
                                      deck.solver.programme.tolerance.value.value_or(0),
                                      state.before.negligible(),
                                      state.before.rounding,
                                      state.before.force,
                                      state.before.slip_error};
  const auto bodies = elastic_bodies(assembly, constitution, *state.symmetric);
  auto results = [&] {
    const auto scope = context.timers.scope("stresses");
    return post::evaluate(equilibrium, bodies, comm);
  }();
  const auto motions = assembly.model().motions_of_points(state.displacement, comm);
  for (std::size_t i = 0; i < motions.size(); ++i) results.forces.couplings[i].motion = motions[i];
  if (results.verdict.status == ExitStatus::no_equilibrium) throw Error(results.verdict.status, results.verdict.reason);
  auto& fields = results.fields;
  if (probes.any_inside()) {
    const auto scope = context.timers.scope("interior");
    fields.interior = post::evaluate_interior(bodies, probes, state.displacement, fields.stress, comm);
  }
  if (!probes.extremes.empty())
    fields.extremes = post::find_extremes(bodies.decomposition, probes, state.displacement, fields.stress, fields.interior,
                                          state.rows->pairs, results.contact.surfaces, comm);
  return results;
}

}  // namespace mortise::analysis
