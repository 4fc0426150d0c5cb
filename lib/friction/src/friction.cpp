#include "friction/friction.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "qp/error_estimate.hpp"
#include "qp/smalse.hpp"

namespace mortise::friction {

namespace {

constexpr double loose = 1e-2;         // tolerance of the first Tresca problem, and the loosest of all
constexpr double finest = 1e-7;        // tolerance of SMALSE-M that is enough where no error is allowed
constexpr double worth_a_look = 0.05;  // change of the slip bounds at which the allowed error is asked for

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

[[noreturn]] void no_equilibrium(const feti::DualProblem& problem, const Eigen::VectorXd& nu)
{
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
  CoulombBounds(feti::DualProblem& problem, const std::vector<Law>& laws)
      : problem_(problem), laws_(laws), now_(slip_bounds(problem, laws, nullptr)), before_(now_)
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

// How far to go towards the next bounds of the fixed point: Aitken's rule, which makes a swing about a point settle there [Irons
// and Tuck, IJNME 1 (1969)].
class Relaxation {
 public:
  explicit Relaxation(const Communicator& comm) : comm_(comm) {}

  double operator()(const std::vector<double>& now, const std::vector<double>& next)
  {
    std::vector<double> step;  // infinite bounds are left in one go
    for (std::size_t i = 0; i < now.size(); ++i)
      step.push_back(std::isinf(now[i]) || std::isinf(next[i]) ? 0.0 : next[i] - now[i]);
    double product = 0, square = 0;
    for (std::size_t i = 0; i < step_.size(); ++i) {
      product += step_[i] * (step[i] - step_[i]);
      square += (step[i] - step_[i]) * (step[i] - step_[i]);
    }
    product = comm_.sum(product);
    square = comm_.sum(square);
    if (square > 0) part_ = std::clamp(-part_ * product / square, shortest, 1.0);
    step_ = std::move(step);
    return part_;
  }

 private:
  static constexpr double shortest = 0.05;
  const Communicator& comm_;
  std::vector<double> step_;  // the one before
  double part_ = 1;
};

// SMALSE-M for one set of slip bounds. Where the goal is an allowed error, with tolerances that fall until it is reached.
qp::Solution solve_by_smalse(const qp::Problem& programme, std::optional<qp::Solution> start, const qp::Goal& goal,
                             const Operator* preconditioner, const qp::Observer& observer)
{
  double tolerance = goal.allowed_error ? loose : goal.residual;
  int outer = 0;
  while (true) {
    qp::Solution found = qp::smalse(programme, start, tolerance, observer);
    found.outer_iterations = outer += found.outer_iterations;
    if (!found.feasible) return found;
    found.error = qp::error_estimate(programme, found, preconditioner);
    if (!goal.allowed_error || !found.converged || tolerance <= finest) return found;
    const double allowed = goal.allowed_error(found.x, found.nu);
    if (found.error <= allowed) return found;
    tolerance = std::max(finest, tolerance * std::clamp(0.5 * allowed / found.error, 0.03, 0.5));
    start = std::move(found);
  }
}

}  // namespace

Result solve(feti::DualProblem& problem, const std::vector<Law>& laws, const Options& options, const qp::Options& solver,
             const AllowedError& allowed_error, const Observer& observer)
{
  const bool coulomb = any_coulomb(laws);
  qp::Hessian hessian(problem.hessian(), solver.max_multiplications);
  const qp::Problem programme{hessian, problem.linear(), problem.equality(), problem.set()};
  std::vector<double> bounds = slip_bounds(problem, laws, nullptr), previous_bounds = bounds;
  std::unique_ptr<qp::FaceNewton> newton;
  if (solver.algorithm == "face_newton") newton = std::make_unique<qp::FaceNewton>(programme, problem.preconditioner());
  qp::Goal goal;
  if (solver.tolerance.value)
    goal.residual = *solver.tolerance.value;
  else
    goal.allowed_error = allowed_error;
  std::optional<qp::Solution> solution;
  double change = 1, least_change = 1;
  Relaxation relaxation(problem.communicator());
  int step = 0, infeasible = 0, outer = 0, preconditionings = 0;
  bool settled = false;
  const auto watch = [&](const qp::Progress& progress) {
    if (observer) observer(step, change, progress);
  };
  if (newton && coulomb) {  // all in one loop; the fixed point below goes on from there where that does not settle
    step = 1;
    CoulombBounds law(problem, laws);
    const auto renewal = law.renewal();
    auto found = newton->solve({}, goal, &renewal, watch);
    outer += found.outer_iterations;
    preconditionings += found.preconditionings;
    if (found.feasible) {
      bounds = slip_bounds(problem, laws, &found.x);
      change = relative_change(bounds, law.now(), programme, found.hessian_norm, problem.communicator());
      // Where the error decides, what the bounds would still change counts in it.
      settled = found.converged && (goal.allowed_error || change <= options.tolerance);
      solution = std::move(found);
    }
  }
  while (!settled) {
    ++step;
    problem.set().set_radii(bounds);
    qp::Goal now = goal;
    if (coulomb)
      now = {std::max(goal.residual, std::min(loose, 0.1 * least_change)), {}};  // looser again would bring swings of its own
    auto next = newton ? newton->solve(solution, now, nullptr, watch)
                       : solve_by_smalse(programme, solution, now, problem.preconditioner(), watch);
    if (!next.feasible) {
      // Bounds from inexact normal forces may fall short by as much: go half way back before giving up.
      if (!solution || ++infeasible > 5) no_equilibrium(problem, next.nu);
      for (std::size_t i = 0; i < bounds.size(); ++i)
        bounds[i] = std::isinf(previous_bounds[i]) ? 2 * bounds[i] : 0.5 * (bounds[i] + previous_bounds[i]);
      continue;
    }
    if (newton && !next.converged &&
        !hessian.exhausted()) {  // it crawls where bodies are soft and slender: the slower, steadier one
      outer += next.outer_iterations;
      preconditionings += next.preconditionings;
      next = solve_by_smalse(programme, next, now, problem.preconditioner(), watch);
      if (!next.feasible) no_equilibrium(problem, next.nu);
    }
    const bool first = !solution;
    solution = std::move(next);
    outer += solution->outer_iterations;
    preconditionings += solution->preconditionings;
    if (!coulomb) {
      settled = true;
      change = 0;
      break;
    }
    auto wanted = slip_bounds(problem, laws, &solution->x);
    change = first ? 1.0 : relative_change(wanted, bounds, programme, solution->hessian_norm, problem.communicator());
    if (goal.allowed_error && std::isfinite(solution->error)) {
      // Bounds that move by so much move the multipliers by about as much, and ||x||_F^2 <= ||F|| ||x||^2.
      solution->error += std::sqrt(solution->hessian_norm) * distance(wanted, bounds, problem.communicator());
      // A mesh without an error of its own (a uniform stress) allows none: bounds and residual at rest are enough, too.
      settled = !first && ((change <= worth_a_look && solution->error <= goal.allowed_error(solution->x, solution->nu)) ||
                           (change <= options.tolerance && solution->converged && now.residual <= 1e-1 * options.tolerance));
    } else {
      settled = !first && change <= options.tolerance && now.residual <= goal.residual;
    }
    if (settled || step >= options.max_steps || hessian.exhausted()) break;
    least_change = first ? 1.0 : std::min(least_change, change);
    const double part = relaxation(bounds, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!std::isinf(bounds[i])) wanted[i] = bounds[i] + part * (wanted[i] - bounds[i]);
    previous_bounds = std::exchange(bounds, std::move(wanted));
  }
  Result result{std::move(*solution)};
  result.steps = step;
  result.change = change;
  result.converged = settled && result.solution.converged;
  if (!result.converged && hessian.exhausted())
    result.limit = "solver.max_multiplications";
  else if (!result.converged && coulomb && step >= options.max_steps)
    result.limit = "friction_loop.max_steps";
  result.multiplications = hessian.count();
  result.preconditionings = preconditionings;
  result.outer_iterations = outer;
  return result;
}

}  // namespace mortise::friction
