#include "friction/friction.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "budget.hpp"
#include "contact_settled.hpp"
#include "open_points.hpp"
#include "qp/error_estimate.hpp"
#include "qp/smalse.hpp"
#include "relaxation.hpp"

namespace mortise::friction {

namespace {

constexpr double loose = 1e-2;               // tolerance of the first Tresca problem, and the loosest of all
constexpr double finest = 1e-7;              // tolerance of SMALSE-M that is enough where no error is allowed
constexpr double rounding_of_direct = 1e-4;  // of the energy norm: error that a direct solution may leave
constexpr double rounding = 1e-12;           // tolerance of SMALSE-M below which there is nothing to gain
constexpr double worth_a_look = 0.05;        // change of the slip bounds at which the allowed error is asked for

// ||a - b|| over all ranks; points that stick without limit in either do not count.
double distance(const std::vector<double>& a, const std::vector<double>& b, const Communicator& comm)
{
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!std::isinf(a[i]) && !std::isinf(b[i])) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(comm.sum(square));
}

// ||next - now|| / ||next||, but for what rounding makes of no force at all: of multipliers of the size ||b|| / ||A||.
double relative_change(const std::vector<double>& next, const std::vector<double>& now, const qp::Problem& programme,
                       double hessian_norm, const Communicator& comm)
{
  constexpr double rounding = 1e-10;
  const double least = hessian_norm > 0 ? rounding * programme.linear.norm2() / hessian_norm : 0;
  const double size = std::max(distance(next, std::vector<double>(next.size(), 0.0), comm), least);
  return size > 0 ? distance(next, now, comm) / size : 0;
}

bool any_coulomb(const std::vector<Law>& laws)
{
  return std::any_of(laws.begin(), laws.end(), [](const Law& law) { return law.kind == Law::Kind::coulomb; });
}

// `proven`: `nu` proves that no forces balance the loads; else the search for such forces just did not settle.
[[noreturn]] void no_equilibrium(const feti::DualProblem& problem, const Eigen::VectorXd& nu, bool proven)
{
  if (!proven)
    throw Error(ExitStatus::bad_input,
                "no forces were found that balance the loads, though nothing proves that there are none: " + problem.runaway(nu) +
                    " nearly freely, and stiffnesses that differ by 1e12 are too far apart for rounding. "
                    "Look at the units of young_modulus and of sizes, or support that body");
  throw Error(ExitStatus::no_equilibrium, "no equilibrium: " + problem.runaway(nu) +
                                              "; contacts can only push and friction is limited, so nothing holds it against "
                                              "the loads. Support it, or look at the direction of the loads and at the friction");
}

}  // namespace

std::vector<double> slip_bounds(const feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda)
{
  const auto& points = problem.constraints().contacts.points;
  std::vector<double> radii(problem.set().discs().size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& rows = problem.points()[i];
    if (rows.disc < 0) continue;
    const Law& law = laws[static_cast<std::size_t>(points[i].contact)];
    double& radius = radii[static_cast<std::size_t>(rows.disc)];
    if (law.kind == Law::Kind::tresca) radius = law.value * points[i].area / problem.jump().scale()[rows.normal];
    if (law.kind == Law::Kind::coulomb)
      radius = lambda ? law.value * std::max(view(*lambda)[rows.normal], 0.0) : std::numeric_limits<double>::infinity();
  }
  return radii;
}

namespace {

// Renews slip bounds between two faces of face Newton.
class CoulombBounds {
 public:
  // Those of the multipliers `lambda`, or of points that all stick if there are none.
  CoulombBounds(feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda)
      : problem_(problem), laws_(laws), now_(slip_bounds(problem, laws, lambda)), before_(now_)
  {
    problem_.set().set_radii(now_);
  }

  qp::Renewal renewal()
  {
    return {[this](const Vector& x, bool apply) { return renew(x, apply); }, [this] { retreat(); }};
  }
  const std::vector<double>& now() const { return now_; }

 private:
  double renew(const Vector& x, bool apply)
  {
    auto wanted = slip_bounds(problem_, laws_, &x);
    double square = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] != now_[i]) square += (wanted[i] - now_[i]) * (wanted[i] - now_[i]);  // infinite while a point sticks anyway
    if (apply) {
      before_ = std::exchange(now_, std::move(wanted));
      problem_.set().set_radii(now_);
    }
    return std::sqrt(problem_.communicator().sum(square));
  }
  void retreat()
  {
    for (std::size_t i = 0; i < now_.size(); ++i) now_[i] = std::isinf(before_[i]) ? 2 * now_[i] : 0.5 * (now_[i] + before_[i]);
    problem_.set().set_radii(now_);
  }

  feti::DualProblem& problem_;
  const std::vector<Law>& laws_;
  std::vector<double> now_, before_;
};

}  // namespace

namespace {

// Forces that bounds just allowed may be more than the law allows, by what bounds and normal forces still differ by. That counts
// as error; and where no forces within the law balance the loads there is no equilibrium, however little they lack. One product.
void judge_by_law(feti::DualProblem& problem, const std::vector<Law>& laws, qp::Hessian& hessian, qp::Solution& solution)
{
  const qp::Projection nearest = qp::project(solution.x, problem.equality(), problem.set().with_cones());
  if (nearest.empty) {  // with bounds that are given bodies slide; along the edge of a cone they would also lift
    problem.set().set_radii(slip_bounds(problem, laws, &solution.x));
    const qp::Projection given = qp::project(solution.x, problem.equality(), problem.set());
    no_equilibrium(problem, given.empty ? given.nu : nearest.nu, true);
  }
  Vector beyond(solution.x, Teuchos::Copy), product(beyond.getMap());
  beyond.update(-1, nearest.point, 1);
  hessian.apply(beyond, product);
  solution.error += std::sqrt(std::max(beyond.dot(product), 0.0));
}

// Whether the residual of a solution with an estimated error that is good enough fits it.
bool fits(const qp::Solution& solution, const qp::Goal& goal)
{
  return solution.projected_gradient <= qp::Goal::largest_residual ||
         qp::believable(solution.error, 0, solution.x, solution.nu, goal);
}

// SMALSE-M for one set of slip bounds. Where the goal is an allowed error, with tolerances that fall until it is reached.
qp::Solution solve_by_smalse(const qp::Problem& programme, std::optional<qp::Solution> start, const qp::Goal& goal,
                             qp::FacePreconditioner* preconditioner, const qp::Observer& observer)
{
  double tolerance = goal.allowed_error ? loose : goal.residual;
  int outer = 0;
  while (true) {
    qp::Solution found = qp::smalse(programme, start, tolerance, observer);
    found.outer_iterations = outer += found.outer_iterations;
    if (!found.feasible) return found;
    found.error = qp::error_bound(programme, found, preconditioner);
    if (!found.converged) return found;
    if (!goal.allowed_error || tolerance <= finest) {
      found.converged =
          qp::believable(found.error, qp::rounding_of_error(programme, found.hessian_norm), found.x, found.nu, goal);
      if (found.converged || tolerance <= rounding) return found;
      tolerance *= 0.1;
    } else {
      const double allowed = goal.allowed_error(found.x, found.nu);
      if (found.error <= allowed && fits(found, goal)) return found;
      tolerance = std::max(finest, tolerance * std::clamp(0.5 * allowed / found.error, 0.03, 0.5));
    }
    start = std::move(found);
  }
}

}  // namespace

// One load step on its way.
struct Solver::Run {
  qp::Goal goal;
  qp::Observer watch;
  std::vector<double> bounds, previous_bounds;
  std::optional<qp::Solution> solution;  // at first that of the load step before
  bool solved = false;                   // `solution` is of this load step
  Eigen::VectorXd escape;                // nu of the last Tresca problem that was infeasible,
  bool proven = false;                   // and whether it proves that
  double change = 1, least_change = 1;
  int step = 0, outer = 0, preconditionings = 0;
  bool settled = false;
  bool steadier = false;  // SMALSE-M has taken over

  void count(const qp::Solution& found)
  {
    outer += found.outer_iterations;
    preconditionings += found.preconditionings;
  }
};

Solver::Solver(feti::DualProblem& problem, std::vector<Law> laws, const Options& options, const qp::Options& solver,
               std::optional<int> patience)
    : problem_(problem),
      laws_(std::move(laws)),
      options_(options),
      solver_(solver),
      patience_(patience),
      hessian_(problem.hessian(), 0),
      budget_(std::make_unique<Budget>(hessian_, solver.max_multiplications.value, solver.algorithm == "smalse")),
      driven_(problem.linear().getMap()),
      programme_{hessian_, problem.linear(), problem.equality(), problem.set(), problem.pull() ? &driven_ : nullptr}
{
  std::vector<double> coefficients(problem.set().discs().size(), 0.0);
  const auto& points = problem.constraints().contacts.points;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const Law& law = laws_[static_cast<std::size_t>(points[i].contact)];
        law.kind == Law::Kind::coulomb && problem.points()[i].disc >= 0)
      coefficients[static_cast<std::size_t>(problem.points()[i].disc)] = law.value;
  problem.set().set_coefficients(coefficients);
  if (solver.algorithm == "direct") explicit_ = std::make_unique<feti::ExplicitProblem>(problem);
  if (solver.algorithm != "smalse")
    newton_ = std::make_unique<qp::FaceNewton>(programme_, explicit_ ? explicit_.get() : problem.preconditioner());
}

Solver::~Solver() = default;

// Bounds and forces together, face by face. Where that does not settle, the fixed point goes on from there.
void Solver::renew_at_faces(Run& run)
{
  run.step = 1;
  // Bounds of the step before may leave no feasible point: then every point sticks at first.
  for (const bool warm : {true, false}) {
    if (warm && !run.solution) continue;
    CoulombBounds law(problem_, laws_, warm ? &run.solution->x : nullptr);
    const auto renewal = law.renewal();
    auto found = newton_->solve(run.solution, run.goal, &renewal, run.watch);
    run.count(found);
    if (!found.feasible) continue;
    run.bounds = slip_bounds(problem_, laws_, &found.x);
    run.change = relative_change(run.bounds, law.now(), programme_, found.hessian_norm, problem_.communicator());
    // Where the error decides, what the bounds would still change counts in it.
    run.settled = found.converged && (run.goal.allowed_error || run.change <= options_.tolerance);
    run.solution = std::move(found);
    run.solved = true;
    return;
  }
}

// One Tresca problem; false if it is infeasible.
bool Solver::solve_tresca(const qp::Goal& goal, Run& run)
{
  problem_.set().set_radii(run.bounds);
  auto next = newton_ ? newton_->solve(run.solution, goal, nullptr, run.watch)
                      : solve_by_smalse(programme_, run.solution, goal, problem_.preconditioner(), run.watch);
  // Faces that rounding has spoilt (stiffnesses that differ by 1e12) prove nothing; the other algorithm needs none.
  if (newton_ && !next.feasible && !next.empty)
    next = solve_by_smalse(programme_, std::nullopt, goal, problem_.preconditioner(), run.watch);
  if (!next.feasible) {
    run.escape = next.nu;
    run.proven = next.empty;
    return false;
  }
  if (newton_ && !next.converged && !patience_ &&
      budget_->left()) {  // it crawls where bodies are soft and slender: the slower, steadier one
    run.count(next);
    if (!std::exchange(run.steadier, true)) budget_->change_algorithm();
    next = solve_by_smalse(programme_, next, goal, problem_.preconditioner(), run.watch);
    if (!next.feasible) {
      run.escape = next.nu;
      run.proven = next.empty;
      return false;
    }
  }
  run.count(next);
  run.solution = std::move(next);
  return true;
}

// Whether the fixed point is at rest, with bounds `wanted` that the last Tresca problem asks for.
bool Solver::at_rest(const std::vector<double>& wanted, double tolerance, Run& run)
{
  auto& solution = *run.solution;
  if (!run.goal.allowed_error || !std::isfinite(solution.error))
    return run.change <= options_.tolerance && tolerance <= run.goal.residual && solution.converged &&
           qp::believable(solution.error, qp::rounding_of_error(programme_, solution.hessian_norm), solution.x, solution.nu,
                          run.goal);
  solution.error += error_of_bounds(wanted, run);
  if (run.change <= worth_a_look && solution.error <= run.goal.allowed_error(solution.x, solution.nu) && fits(solution, run.goal))
    return true;
  // A mesh without an error of its own (a uniform stress) allows none: bounds and residual at rest are enough, too.
  return run.change <= options_.tolerance && solution.converged && tolerance <= 1e-1 * options_.tolerance &&
         qp::believable(solution.error, qp::rounding_of_error(programme_, solution.hessian_norm), solution.x, solution.nu,
                        run.goal);
}

// ||.||_F of what multipliers on the edge of their discs would move by with the bounds `wanted`. One product.
double Solver::error_of_bounds(const std::vector<double>& wanted, const Run& run)
{
  Vector moved(problem_.linear().getMap()), product(moved.getMap());
  {
    const auto x = view(std::as_const(run.solution->x));
    auto to = view(moved);
    const auto discs = problem_.set().discs();
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const Eigen::Vector2d at = qp::from_centre(discs[i], x);
      if (!std::isfinite(wanted[i]) || !std::isfinite(run.bounds[i]) || at.norm() < 0.99 * run.bounds[i] || at.norm() == 0)
        continue;
      for (int k = 0; k < discs[i].size(); ++k)
        to[discs[i].index[static_cast<std::size_t>(k)]] = (wanted[i] - run.bounds[i]) * at[k] / at.norm();
    }
  }
  if (moved.norm2() == 0) return 0;
  problem_.equality().project(moved);
  hessian_.apply(moved, product);
  return std::sqrt(std::max(moved.dot(product), 0.0));
}

// Where forces within the law balance the loads, but those that the bodies' stiffness asks for never do: no equilibrium if they
// fall short by more than this.
void Solver::refuse_if_far(const Run& run)
{
  constexpr double short_of = 0.05;
  auto larger = slip_bounds(problem_, laws_, &run.solution->x);
  for (auto& bound : larger) bound *= 1 + short_of;
  problem_.set().set_radii(larger);
  const qp::Projection nearest = qp::project(run.solution->x, problem_.equality(), problem_.set());
  if (nearest.empty) no_equilibrium(problem_, nearest.nu, true);
}

// Bounds that leave a feasible point: those of the forces within the cones of friction that balance the loads and are nearest to
// the present ones. Where there are none, nothing obeys the law. In a set of given bounds they would be on the edge, so bounds
// are a little larger.
void Solver::admit(Run& run)
{
  constexpr double room = 1 + 1e-6;
  constexpr double balanced = 1e-6;  // of all forces: what a search that does not settle may leave
  const qp::FeasibleSet cones = problem_.set().with_cones();
  const qp::Projection nearest = qp::project(run.solution->x, problem_.equality(), cones);
  if (!nearest.found && nearest.residual > balanced)
    no_equilibrium(problem_, run.proven ? run.escape : nearest.nu, nearest.empty);
  run.bounds = slip_bounds(problem_, laws_, &nearest.point);
  for (auto& bound : run.bounds) bound *= room;
}

// Tresca problems until their bounds are at rest.
void Solver::fixed_point(Run& run)
{
  constexpr int retreats = 4;  // in a row
  constexpr int most_failures = 15;
  Relaxation relaxation(problem_.communicator());
  int infeasible = 0, failures = 0;
  double strictness = 1;
  if (!run.settled) budget_->change_algorithm();
  while (!run.settled) {
    ++run.step;
    // Looser again would bring swings of its own; and bounds that rest but for a loose tolerance would stay where they are.
    const double tightest =
        std::max(rounding, strictness * (run.goal.allowed_error ? 0.1 * options_.tolerance : run.goal.residual));
    const double tolerance =
        run.least_change <= options_.tolerance ? tightest : std::max(tightest, std::min(loose, 0.1 * run.least_change));
    const bool first = !run.solved;
    if (!solve_tresca({tolerance}, run)) {
      if (!run.solved) no_equilibrium(problem_, run.escape, run.proven);
      if (++failures > most_failures || run.step >= options_.max_steps) {
        refuse_if_far(run);
        return;
      }
      // Bounds from inexact normal forces may fall short by as much: half way back, now and then to what surely is feasible.
      auto half_way = run.bounds;
      for (std::size_t i = 0; i < half_way.size(); ++i)
        half_way[i] = std::isinf(run.previous_bounds[i]) ? 2 * half_way[i] : 0.5 * (half_way[i] + run.previous_bounds[i]);
      admit(run);
      if (++infeasible % retreats != 0) run.bounds = std::move(half_way);
      continue;
    }
    run.solved = true;
    infeasible = 0;
    auto wanted = slip_bounds(problem_, laws_, &run.solution->x);
    run.change =
        first ? 1.0 : relative_change(wanted, run.bounds, programme_, run.solution->hessian_norm, problem_.communicator());
    run.settled = !first && at_rest(wanted, tolerance, run);
    // Bounds at rest beside an error that is too large.
    if (!run.settled && run.change <= options_.tolerance && tolerance <= tightest) strictness *= 0.1;
    if (run.settled || run.step >= options_.max_steps || hessian_.exhausted()) return;
    run.least_change = first ? 1.0 : std::min(run.least_change, run.change);
    const double part = relaxation(run.bounds, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!std::isinf(run.bounds[i])) wanted[i] = run.bounds[i] + part * (wanted[i] - run.bounds[i]);
    run.previous_bounds = std::exchange(run.bounds, std::move(wanted));
  }
}

// The exact solution, from which face Newton then starts: it needs no more than the products that show it.
void Solver::solve_directly(Run& run)
{
  problem_.set().set_radii(run.bounds);
  run.watch({"direct", 0, hessian_.count()});
  auto found = explicit_->solve();
  if (found.settled && run.goal.allowed_error) run.goal.exact = rounding_of_direct;
  qp::Solution solution(found.x, found.x, found.nu);
  if (run.solution) solution.hessian_norm = run.solution->hessian_norm;
  run.solution = std::move(solution);
}

Result Solver::solve(const qp::Solution* start, const Accuracy& accuracy, const Observer& observer)
{
  const bool coulomb = any_coulomb(laws_);
  const int before = hessian_.count();
  budget_->start(patience_);
  states_ = std::make_unique<StateRecord>();
  if (problem_.pull()) hessian_.apply(*problem_.pull(), driven_);
  Run run;
  if (solver_.tolerance.value) {
    run.goal.residual = *solver_.tolerance.value;
  } else {
    run.goal.allowed_error = accuracy.allowed_error;
    run.goal.settled = [this](const Vector& x, const Vector& argument, const Vector& off) {
      return contact_settled(problem_, x, argument, off);
    };
  }
  run.goal.energy_norm = accuracy.energy_norm;
  if (start) run.solution = *start;
  run.bounds = run.previous_bounds = slip_bounds(problem_, laws_, nullptr);
  run.watch = [&](const qp::Progress& progress) {
    note(run, progress);
    if (observer) observer(run.step, run.change, progress);
  };
  if (explicit_) solve_directly(run);
  if (coulomb) {
    if (newton_) renew_at_faces(run);
    if (!patience_ || !run.solved) fixed_point(run);
    if (run.solved && (run.settled || !hessian_.exhausted())) judge_by_law(problem_, laws_, hessian_, *run.solution);
  } else {
    run.step = 1;
    if (!solve_tresca(run.goal, run)) no_equilibrium(problem_, run.escape, run.proven);
    run.settled = true;
    run.change = 0;
  }
  Result result{std::move(*run.solution)};
  result.steps = run.step;
  result.change = run.change;
  result.converged = run.settled && result.solution.converged;
  result.gave_up = patience_ && !result.converged && budget_->left();
  if (!result.converged && hessian_.exhausted())
    result.limit = budget_->reason();
  else if (!result.converged && coulomb && run.step >= options_.max_steps)
    result.limit = "friction_loop.max_steps";
  result.multiplications = hessian_.count() - before;
  result.preconditionings = run.preconditionings;
  result.outer_iterations = run.outer;
  if (!result.gave_up) tell_what_is_open(result);
  return result;
}

void Solver::note(const Run& run, const qp::Progress& progress)
{
  std::optional<long long> changes;
  if (progress.point) changes = problem_.communicator().sum(states_->note(states_at(problem_, *progress.point)));
  budget_->note(progress, changes, run.change);
}

// What the last residual still changes, by the preconditioner. No product.
void Solver::tell_what_is_open(Result& result)
{
  const auto& bonded = problem_.constraints().contacts.bonded;
  const bool any = std::find(bonded.begin(), bonded.end(), false) != bonded.end();
  if (!problem_.communicator().any(any)) return;
  qp::FacePreconditioner* preconditioner = explicit_ ? explicit_.get() : problem_.preconditioner();
  const auto foretold = preconditioner ? foretell(problem_, result.solution, *preconditioner) : std::nullopt;
  if (foretold) result.undecided = undecided(problem_, result.solution.x, *foretold);
  if (!result.converged) result.stuck = stuck(problem_, *states_, result.solution.x, foretold ? &*foretold : nullptr);
}

}  // namespace mortise::friction
