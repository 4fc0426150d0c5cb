#include "qp/smalse.hpp"

#include <algorithm>
#include <cmath>

#include "qp/mpgp.hpp"
#include "qp/norm.hpp"
#include "qp/projection.hpp"

namespace mortise::qp {

namespace {

constexpr double start_precision = 0.25;  // M0; smaller than the usual 1, since the start is feasible and mu is known roughly
constexpr double shrink_precision = 0.5;  // beta: M falls by this when the Lagrangian did not rise enough
constexpr double start_accuracy = 0.1;    // eta, relative to ||P b||
constexpr int max_outer_iterations = 1000;
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
  constant.update(-1, problem.linear, 1);
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
    Projection next = project(moved, problem.equality, problem.set);
    if (!next.found) break;
    nu = next.nu / start_length;
    feasible = std::move(next);
    set_constant(problem, feasible.point, norm, constant);
  }
}

// L = 1/2 z'(g + c) with g = H z + c, c = P(A x0 - b)/nrm + G' nu. Collective.
double value_of(const Problem& problem, const Vector& constant, const Eigen::VectorXd& nu, const Point& point)
{
  Vector c(constant, Teuchos::Copy);
  problem.equality.add_transpose(1, nu, c);
  c.update(1, point.gradient, 1);
  return 0.5 * point.x.dot(c);
}

}  // namespace

Solution smalse(const Problem& problem, const std::optional<Solution>& start, double tolerance, const Observer& observer)
{
  auto& [hessian, linear, equality, set, driven] = problem;
  const auto map = hessian.map();

  Projection feasible = project(start ? start->x : Vector(map), equality, set);
  Solution result(feasible.point, Vector(map), feasible.nu);
  if (!feasible.found) {
    result.feasible = false;
    result.empty = feasible.empty;
    return result;
  }
  result.hessian_norm = start ? start->hessian_norm : projected_norm(hessian, equality);
  if (observer && !start) observer({"norm", 0, hessian.count()});
  result.precision = start ? start->precision : start_precision;
  Eigen::VectorXd nu =
      start && start->augmented.size() == equality.size() ? start->augmented : Eigen::VectorXd::Zero(equality.size());
  double norm = result.hessian_norm;
  if (norm == 0) norm = 1;
  double size = relative_size(problem, tolerance) / norm;
  if (size == 0) size = 1;

  Vector constant(map);
  set_constant(problem, feasible.point, norm, constant);
  if (!start) take_start_steps(problem, norm, feasible, constant, nu);
  const Vector origin(feasible.point, Teuchos::Copy);
  const FeasibleSet moved = set.shifted(view(origin));

  AugmentedLagrangian lagrangian(problem, norm);
  const Product product = [&](const Vector& z, Vector& y) { lagrangian.apply(z, y); };
  Point point{Vector(map), Vector(constant, Teuchos::Copy)};
  equality.add_transpose(1, nu, point.gradient);

  double largest = 1;  // ||P A P / nrm + Q||, raised by mpgp when it shows to be more
  double previous = -std::numeric_limits<double>::infinity();
  double residual = 0, measure = 0;
  Eigen::VectorXd defect;
  const auto report = [&](const char* what, const Vector* at = nullptr) {
    if (observer)
      observer({what, result.outer_iterations, hessian.count(), measure / size, residual / size, result.precision,
                moved.active(view(std::as_const(point.x))), 0, std::numeric_limits<double>::quiet_NaN(),
                std::numeric_limits<double>::quiet_NaN(), at});
  };
  while (true) {
    const auto done = [&](double reduced, const Point& at) {
      measure = reduced;
      if (equality.size() > 0) {
        const Eigen::VectorXd gz = equality.apply(at.x);
        defect = equality.solve(gz);
        residual = std::sqrt(std::max(gz.dot(defect), 0.0));
      }
      report("inner");
      if (measure <= tolerance * size && residual <= tolerance * size) return true;
      return measure <= std::min(result.precision * residual, start_accuracy * size) || hessian.exhausted();
    };
    mpgp(product, moved, point, largest, {}, done);
    ++result.outer_iterations;
    {
      Vector at(origin, Teuchos::Copy);
      at.update(1, point.x, 1);
      report("outer", &at);
    }
    result.converged = measure <= tolerance * size && residual <= tolerance * size;
    if (result.converged || hessian.exhausted() || result.outer_iterations >= max_outer_iterations) break;

    const double value = value_of(problem, constant, nu, point);
    if (value < previous + 0.5 * residual * residual) result.precision *= shrink_precision;
    previous = value;
    if (equality.size() == 0) continue;
    nu += defect;
    equality.add_transpose(1, defect, point.gradient);
  }
  if (defect.size() > 0) nu += defect;
  result.hessian_norm = norm * largest;
  result.augmented = nu / largest;  // in the scaling of the next solve
  result.projected_gradient = measure / size;
  result.equality = residual / size;

  // Back to x = x0 + z, with what is left of G z removed exactly, and to nu of the unscaled problem.
  result.x.update(1, origin, 1, point.x, 0);
  result.x.assign(project(result.x, equality, set).point);
  hessian.apply(result.x, result.gradient);
  result.gradient.update(-1, linear, 1);
  Vector coarse(result.gradient, Teuchos::Copy);
  result.nu = equality.size() > 0 ? Eigen::VectorXd(norm * nu - equality.project(coarse)) : Eigen::VectorXd();
  return result;
}

}  // namespace mortise::qp
