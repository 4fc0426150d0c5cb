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
  const auto common = std::min<Eigen::Index>({nu.size(), solution.nu.size(), from.kernel_dimension(), to.kernel_dimension()});
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

std::unique_ptr<feti::DualProblem> make_problem(const Assembly& assembly, const Rows& rows, std::vector<Eigen::VectorXd> load,
                                                const Context& context)
{
  auto problem = std::make_unique<feti::DualProblem>(
      assembly.decomposition(), assembly.directory(), assembly.interface(), rows.constraints, assembly.system(), std::move(load),
      assembly.deck().solver.subdomains, context, sliding_surfaces_of(rows, assembly.model(), context.comm),
      assembly.model().opposed_loads(rows.acts, context.comm));
  context.log.line("  dual problem: {} multipliers, {} kernel dimensions", problem->dual_unknowns(), problem->kernel_dimension());
  return problem;
}

}  // namespace

StepProblem make_dual_problem(const Assembly& assembly, Rows rows, const Context& context)
{
  StepProblem problem;
  std::vector<Eigen::VectorXd> load;
  {
    const auto scope = context.timers.scope("assembly");
    rows = place(std::move(rows), assembly.model(), assembly.directory(), {}, context.comm);
    problem.symmetric = symmetric_nodes_of(rows, assembly, context.comm);
    load = assembly.loads(rows.acts, context.comm);
    problem.rows = std::make_shared<const Rows>(std::move(rows));
  }
  const auto scope = context.timers.scope("solve");
  problem.dual = make_problem(assembly, *problem.rows, std::move(load), context);
  return problem;
}

LoadStepSolver::LoadStepSolver(const Assembly& assembly, StepProblem first, Approach approach, const Context& context)
    : assembly_(assembly),
      context_(context),
      approach_(std::move(approach)),
      rows_(std::move(first.rows)),
      symmetric_(std::move(first.symmetric)),
      problem_(std::move(first.dual)),
      before_(approach_.spent)
{
  const auto scope = context.timers.scope("solve");
  make_solver();
}

// The rows of a state, and what goes with them. Collective.
void LoadStepSolver::take_rows(Rows rows)
{
  symmetric_ = symmetric_nodes_of(rows, assembly_, context_.comm);
  rows_ = std::make_shared<const Rows>(std::move(rows));
}

void LoadStepSolver::make_solver()
{
  auto options = assembly_.deck().solver.programme;
  options.algorithm = approach_.algorithm;
  if (auto& most = options.max_multiplications.value) *most -= before_;
  if (qp::solver_kind(options.algorithm).exact_products) problem_->be_exact();
  solver_.emplace(*problem_, model::friction_laws(assembly_.model().contacts()), assembly_.deck().friction_loop, options);
}

// Of a state, which is that of the problem still, and of those before it. Collective.
Magnitudes LoadStepSolver::up_to(const StepState& state) const
{
  const auto scope = context_.timers.scope("solve");
  const auto& comm = context_.comm;
  Magnitudes result = state.before;
  const auto constitution = assembly_.model().constitution(rows_->acts);
  result.energy_norm = std::max(result.energy_norm, norms(constitution, state.solved.solution.x, state.displacement).whole);
  const auto sizes = post::body_sizes(assembly_.decomposition(), assembly_.deck().kinematics, comm);
  result.rounding.take(post::rounding(state.displacement, problem_->load(), assembly_.system().nodal_stiffness,
                                      problem_->dimension(), *std::max_element(sizes.begin(), sizes.end()), comm));
  double square = 0;
  for (const auto& f : problem_->jump().apply_transpose(state.solved.solution.x)) square += f.squaredNorm();
  result.force = std::max(result.force, std::sqrt(comm.sum(square)));
  result.rounding.force = std::max(result.rounding.force, part_to_balance * result.force);
  const bool slides = comm.any(!problem_->set().discs().empty());
  if (slides && std::isfinite(state.solved.solution.error)) result.slip_error += state.solved.solution.error;
  return result;
}

// Makes the problem that of the state `acts`, in place if its rows stay, and turns `from`, the state before, into a start for it.
// Collective.
void LoadStepSolver::update(const model::LoadState& acts, StepState& from)
{
  const auto& comm = context_.comm;
  const auto& model = assembly_.model();
  first_ = false;
  std::vector<Eigen::VectorXd> load;
  {
    const auto scope = context_.timers.scope("assembly");
    load = assembly_.loads(acts, comm);
  }
  const auto scope = context_.timers.scope("solve");
  Rows rows = *from.rows;
  const Eigen::VectorXd jumps = problem_->jumps(from.displacement) - problem_->given_way(from.solved.solution.x);
  const auto& ranges = problem_->jump().ranges();
  constraint::remember_slip(rows.constraints.contacts,
                            {jumps.data() + ranges.contacts, static_cast<std::size_t>(ranges.extra - ranges.contacts)});

  auto same = with_new_bounds(rows, model, assembly_.directory(), acts, from.shortenings, comm);
  const bool same_sections = rows.constraints.pretension_sections.empty() || acts.locked == rows.acts.locked;
  if (same && same_sections && problem_->update_rhs(same->constraints, load, model.opposed_loads(acts, comm))) {
    take_rows(std::move(*same));
    return;
  }
  if (!same) {
    same = place(make_rows(model, acts, from.shortenings, context_), model, assembly_.directory(), from.shortenings, comm);
    carry_slip(rows.constraints.contacts, same->constraints.contacts);
  }
  take_rows(std::move(*same));
  before_ = applications();
  solver_.reset();
  auto next = make_problem(assembly_, *rows_, std::move(load), context_);
  from.solved.solution = carry_solution(*problem_, from.solved.solution, *next);
  problem_ = std::move(next);
  make_solver();
}

LoadStepSolver::Norms LoadStepSolver::norms(std::span<const fem::Constitution> constitution, const Vector& lambda,
                                            const std::vector<Eigen::VectorXd>& displacement) const
{
  const auto bodies = elastic_bodies(assembly_, constitution, *symmetric_);
  const auto [error, strain] = post::energy_norms(bodies, displacement, context_.comm);
  const double whole =
      std::hypot(strain, problem_->springs() ? std::sqrt(std::max(problem_->springs()->stored(lambda), 0.0)) : 0);
  return {error, std::max(strain, strained * whole), whole};
}

StepState LoadStepSolver::solve(const model::LoadState& acts, std::optional<StepState> before, const Observer& observer)
{
  const auto magnitudes = before ? up_to(*before) : Magnitudes{};
  if (before) update(acts, *before);
  const auto scope = context_.timers.scope("solve");
  const auto constitution = assembly_.model().constitution(acts);
  const auto norms_at = [&](const Vector& lambda, const Eigen::VectorXd& nu) {
    const auto estimating = context_.timers.scope("error estimate");
    return norms(constitution, lambda, problem_->displacement(lambda, nu));
  };
  const auto allowed_error = [](const Norms& at) {
    return std::clamp(algebraic_part * at.error, smallest_part * at.whole, largest_part * at.size);
  };
  const qp::Goal accuracy{
      .allowed_error = [&](const Vector& lambda, const Eigen::VectorXd& nu) { return allowed_error(norms_at(lambda, nu)); },
      .expected_allowed_error =
          [&](const Vector& lambda, const Eigen::VectorXd& nu) {
            const auto estimating = context_.timers.scope("error estimate");
            return allowed_error(norms(constitution, lambda, problem_->displacement_of_product(lambda, nu)));
          },
      .incompatibility =
          [&](const Vector& lambda, const Eigen::VectorXd& nu) {
            return post::incompatibility(*problem_, assembly_.decomposition(), assembly_.interface(),
                                         problem_->displacement(lambda, nu), nu);
          },
      .energy_norm = [&](const Vector& lambda, const Eigen::VectorXd& nu) { return norms_at(lambda, nu).size; },
      .negligible = magnitudes.negligible()};
  const auto count_on = [&](int step, double change, qp::Progress progress) {
    progress.applications += before_;
    observer(step, change, progress);
  };
  auto patience = before ? before->patience : approach_.patience;
  std::optional<qp::Solution> start;
  if (before)
    start = before->solved.solution;
  else if (approach_.contact)
    solver_->suggest(approach_.contact->states_for(*problem_, context_.comm));
  auto found = solver_->solve(start, accuracy, count_on, patience);
  if (found.gave_up) return {rows_, symmetric_, std::move(found), {}, {}, patience, magnitudes};
  if (approach_.kind == Approach::Kind::direct_instead)
    patience.reset();  // what it has solved is not thrown away for a later state
  found.solution.nu = problem_->least_motion(found.solution.x, found.solution.nu, magnitudes.unfelt());
  auto displacement = problem_->displacement(found.solution.x, found.solution.nu);
  refuse_support_of_facets(*problem_, assembly_, *rows_, found, displacement);
  auto shortenings = problem_->shortenings(found.solution.nu);
  return {rows_, symmetric_, std::move(found), std::move(displacement), std::move(shortenings), patience, magnitudes};
}

StepState LoadStepSolver::take_up(const model::LoadState& acts, std::optional<StepState> before, const Record& record)
{
  const auto magnitudes = before ? up_to(*before) : Magnitudes{};
  if (before) update(acts, *before);
  const auto patience = before ? before->patience : approach_.patience;
  auto found = solution_of(record, *problem_);
  before_ += found.applications;
  auto displacement = problem_->displacement(found.solution.x, found.solution.nu);
  auto shortenings = problem_->shortenings(found.solution.nu);
  return {rows_, symmetric_, std::move(found), std::move(displacement), std::move(shortenings), patience, magnitudes};
}

Outcome LoadStepSolver::given_up(const StepState& state) const
{
  Outcome outcome{.status = {}, .next = approach_.next, .spent = applications()};
  if (first_)
    outcome.contact =
        std::make_shared<const CarriedContact>(CarriedContact(*problem_, state.solved.solution).spread(context_.comm));
  return outcome;
}

post::Results evaluate(const Assembly& assembly, const LoadStepSolver& solver, const StepState& state, const post::Probes& probes,
                       const Context& context)
{
  const auto& comm = context.comm;
  const auto& deck = assembly.deck();
  const auto constitution = assembly.model().constitution(state.rows->acts);
  const post::Equilibrium equilibrium{solver.problem(),
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
  for (std::size_t i = 0; i < motions.size(); ++i) results.couplings[i].motion = motions[i];
  if (results.verdict.status == ExitStatus::no_equilibrium) throw Error(results.verdict.status, results.verdict.reason);
  if (probes.any_inside()) {
    const auto scope = context.timers.scope("interior");
    results.interior = post::evaluate_interior(bodies, probes, state.displacement, results.stress, comm);
  }
  if (!probes.extremes.empty())
    results.extremes = post::find_extremes(bodies.decomposition, probes, state.displacement, results.stress, results.interior,
                                           state.rows->pairs, results.contact.surfaces, comm);
  return results;
}

}  // namespace mortise::analysis
