#include "qp/smalse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "qp/mpgp.hpp"
#include "qp/norm.hpp"
#include "qp/projection.hpp"

namespace mortise::qp {

namespace {

constexpr int start_steps = 3;        // gradient projections of a cold start
constexpr double start_length = 1.5;  // their length, over ||P A P||

// The problem divided by nrm = ||P A P|| and moved to x = x0 + z with a feasible x0:
//     L(z, mu) = 1/2 z'(P A P / nrm + rho Q) z + z'P g0 / nrm + mu'S G z,   rho = 1,
// where G' S' mu is kept as G' nu, so that the factor S of (G G')^-1 = S'S is never needed.
class AugmentedLagrangian {
 public:
  AugmentedLagrangian(const Problem& problem, double norm) : problem_(problem), norm_(norm), work_(problem.hessian.map()) {}

  // y = (P A P / nrm + Q) z
  void apply(const Vector& z, Vector& y)
  {
    work_.assign(z);
    problem_.equality.project(work_);
    problem_.hessian.apply(work_, y);
    problem_.equality.project(y);
    y.update(1, z, -1, work_, 1 / norm_);
  }

 private:
  const Problem& problem_;
  double norm_;
  Vector work_;
};

// P (A x0 - b) / nrm. Collective.
void set_constant(const Problem& problem, const Vector& x0, double norm, Vector& constant)
{
  problem.hessian.apply(x0, constant);
  constant.update(-1, problem.right.b, 1);
  problem.equality.project(constant);
  constant.scale(1 / norm);
}

// A cold start takes gradient projections on {G x = e} intersected with Omega, which cost one product each and, through the
// multipliers of the last projection, tell how hard the equality constraint pulls. Moves `feasible` and what depends on it.
void take_start_steps(const Problem& problem, double norm, Projection& feasible, Vector& constant, Eigen::VectorXd& nu)
{
  for (int step = 0; step < start_steps; ++step) {
    Vector moved(feasible.point, Teuchos::Copy);
    moved.update(-start_length, constant, 1);
    Projection next = project(moved, problem.equality, problem.right.e, problem.set);
    if (!next.found) break;
    nu = next.nu / start_length;
    feasible = std::move(next);
    set_constant(problem, feasible.point, norm, constant);
  }
}

// L = 1/2 z'(g + c) with g = H z + c, c = P(A x0 - b)/nrm + G' nu. Collective.
double value_of(const Problem& problem, const Vector& constant, const Eigen::VectorXd& nu, const Iterate& point)
{
  Vector c(constant, Teuchos::Copy);
  problem.equality.add_transpose(1, nu, c);
  c.update(1, point.gradient, 1);
  return 0.5 * point.x.dot(c);
}

// Where the iteration begins, and what it measures by.
struct SmalseStart {
  double norm = 1, size = 1;  // nrm; ||P b||/nrm or the like, which residuals are relative to
  Projection feasible;        // its point is x0
  Vector constant;            // P (A x0 - b) / nrm
  Eigen::VectorXd nu;
};

// `hessian_norm`: ||P A P||. Collective.
SmalseStart make_start(const Problem& problem, const std::optional<Solution>& start, double hessian_norm, double tolerance,
                       Projection feasible)
{
  const auto coarse = problem.equality.size();
  SmalseStart result{1, 1, std::move(feasible), Vector(problem.hessian.map()),
                     start && start->augmented.size() == coarse ? start->augmented : Eigen::VectorXd::Zero(coarse)};
  if (hessian_norm != 0) result.norm = hessian_norm;
  if (const double size = relative_size(problem, tolerance) / result.norm; size != 0) result.size = size;
  set_constant(problem, result.feasible.point, result.norm, result.constant);
  if (!start) take_start_steps(problem, result.norm, result.feasible, result.constant, result.nu);
  return result;
}

// The iteration on z = x - x0. Refers to its arguments; `result` takes what it comes to.
class SmalseRun {
 public:
  SmalseRun(const Problem& problem, const SmalseStart& start, double tolerance, const Observer& observer, Solution& result)
      : problem_(problem),
        observer_(observer),
        norm_(start.norm),
        size_(start.size),
        limit_(tolerance * size_),
        result_(result),
        constant_(start.constant),
        origin_(start.feasible.point, Teuchos::Copy),
        set_(problem.set.shifted(view(origin_))),
        point_{Vector(problem.hessian.map()), Vector(start.constant, Teuchos::Copy)},
        nu_(start.nu)
  {
    problem.equality.add_transpose(1, nu_, point_.gradient);
  }

  void iterate();
  // Back to x = x0 + z, with what is left of G z removed exactly, and to nu of the unscaled problem.
  void finish();

 private:
  void report(const char* what, const Vector* at = nullptr) const;
  bool is_solved() const { return measure_ <= limit_ && residual_ <= std::max(limit_, rounding_); }
  bool is_minimised(double reduced, const Iterate& at);

  const Problem& problem_;
  const Observer& observer_;
  double norm_, size_, limit_;
  Solution& result_;
  const Vector& constant_;
  Vector origin_;
  FeasibleSet set_;  // of z
  Iterate point_;
  Eigen::VectorXd nu_, defect_;  // defect: Q z as a step of nu
  double largest_ = 1;           // ||P A P / nrm + Q||, raised by mpgp when it shows to be more
  double residual_ = 0, measure_ = 0;
  double rounding_ = 0;  // of residual_
};

void SmalseRun::report(const char* what, const Vector* at) const
{
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (observer_)
    observer_({what, result_.outer_iterations, problem_.hessian.count(), measure_ / size_, residual_ / size_, result_.precision,
               set_.active(view(std::as_const(point_.x))), 0, unknown, unknown, at, at ? &problem_.set : nullptr});
}

// Whether the inner iteration may end here. Takes note of both residuals.
bool SmalseRun::is_minimised(double reduced, const Iterate& at)
{
  measure_ = reduced;
  if (problem_.equality.size() > 0) {
    const Eigen::VectorXd gz = problem_.equality.apply(at.x);
    defect_ = problem_.equality.solve(gz);
    residual_ = std::sqrt(std::max(gz.dot(defect_), 0.0));
    rounding_ = limits::Smalse::rounding * at.x.norm2();
  }
  report("inner");
  if (is_solved()) return true;
  return measure_ <= std::min(result_.precision * residual_, limits::Smalse::start_accuracy * size_) ||
         problem_.hessian.exhausted();
}

void SmalseRun::iterate()
{
  AugmentedLagrangian lagrangian(problem_, norm_);
  const Product product = [&](const Vector& z, Vector& y) { lagrangian.apply(z, y); };
  double previous = -std::numeric_limits<double>::infinity();
  while (true) {
    mpgp(product, set_, point_, largest_, {}, [&](double reduced, const Iterate& at) { return is_minimised(reduced, at); });
    ++result_.outer_iterations;
    {
      Vector at(origin_, Teuchos::Copy);
      at.update(1, point_.x, 1);
      report("outer", &at);
    }
    result_.converged = is_solved();
    if (result_.converged || problem_.hessian.exhausted() || result_.outer_iterations >= limits::Smalse::most_outer) break;
    const double value = value_of(problem_, constant_, nu_, point_);
    if (value < previous + 0.5 * residual_ * residual_) result_.precision *= limits::Smalse::shrink_precision;
    previous = value;
    if (problem_.equality.size() == 0) continue;
    nu_ += defect_;
    problem_.equality.add_transpose(1, defect_, point_.gradient);
  }
  if (defect_.size() > 0) nu_ += defect_;
}

void SmalseRun::finish()
{
  const auto& equality = problem_.equality;
  result_.hessian_norm = norm_ * largest_;
  result_.augmented = nu_ / largest_;  // in the scaling of the next solve
  result_.projected_gradient = measure_ / size_;
  result_.x.update(1, origin_, 1, point_.x, 0);
  result_.x.assign(project(result_.x, equality, problem_.right.e, problem_.set).point);
  if (residual_ <= rounding_ && equality.size() > 0) residual_ = equality.norm(problem_.right.e - equality.apply(result_.x));
  result_.equality = residual_ / size_;
  problem_.hessian.apply(result_.x, result_.gradient);
  result_.gradient.update(-1, problem_.right.b, 1);
  Vector coarse(result_.gradient, Teuchos::Copy);
  result_.nu = equality.size() > 0 ? Eigen::VectorXd(norm_ * nu_ - equality.project(coarse)) : Eigen::VectorXd();
}

}  // namespace

Solution smalse(const Problem& problem, const std::optional<Solution>& start, double tolerance, const Observer& observer)
{
  const auto map = problem.hessian.map();
  Projection feasible = project(start ? start->x : Vector(map), problem.equality, problem.right.e, problem.set);
  Solution result(feasible.point, Vector(map), feasible.nu);
  result.radii = problem.set.radii();
  if (!feasible.found) {
    result.feasible = false;
    result.empty = feasible.empty;
    return result;
  }
  result.hessian_norm = start ? start->hessian_norm : projected_norm(problem.hessian, problem.equality);
  if (observer && !start) observer({"norm", 0, problem.hessian.count()});
  result.precision = start ? start->precision : limits::Smalse::start_precision;
  const auto begin = make_start(problem, start, result.hessian_norm, tolerance, std::move(feasible));
  SmalseRun run(problem, begin, tolerance, observer, result);
  run.iterate();
  run.finish();
  return result;
}

}  // namespace mortise::qp
