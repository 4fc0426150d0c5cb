#include "qp/error_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::qp {

namespace {

// Unknowns that stay where they are whatever closes the gaps: open points that are farther apart than the gaps that are left.
std::vector<Local> far_from_contact(const Problem& problem, const Vector& x, const Projection& natural, double largest)
{
  const auto now = view(x), argument = view(natural.argument), point = view(natural.point);
  std::vector<Local> fixed;
  for (const auto& bound : problem.set.bounds())
    if (now[bound.index] <= bound.lower && point[bound.index] <= bound.lower &&
        now[bound.index] - argument[bound.index] > 2 * largest)
      fixed.push_back(bound.index);
  for (const auto& disc : problem.set.discs())
    if (disc.radius == 0) fixed.insert(fixed.end(), disc.index.begin(), disc.index.begin() + disc.size());
  return fixed;
}

}  // namespace

double error_bound(const Problem& problem, const Vector& x, const Projection& natural, double norm,
                   ActiveSetPreconditioner* preconditioner)
{
  Vector residual(x, Teuchos::Copy), reaction(natural.point, Teuchos::Copy);
  residual.update(-1, natural.point, 1);
  reaction.update(-1, natural.argument, 1);
  const double slackness = std::max(norm * reaction.dot(residual), 0.0);
  const double largest = residual.normInf();
  residual.scale(norm);
  double square = 0;
  if (preconditioner) {
    preconditioner->fix(far_from_contact(problem, x, natural, largest), {});
    square = std::max(preconditioner->energy(residual), 0.0);
  } else {
    square = residual.dot(residual) / norm;
  }
  return 0.5 * (std::sqrt(square) + std::sqrt(square + 4 * slackness));
}

double error_bound(const Problem& problem, const Solution& solution, ActiveSetPreconditioner* preconditioner)
{
  const double norm = solution.hessian_norm > 0 ? solution.hessian_norm : 1;
  Vector moved(solution.x, Teuchos::Copy);
  moved.update(-1 / norm, solution.gradient, 1);
  return error_bound(problem, solution.x, project(moved, problem.equality, problem.right.e, problem.set), norm, preconditioner);
}

double rounding_of_error(const Vector& b, double norm)
{
  constexpr double part = 1e-7;
  return part * b.norm2() / std::sqrt(norm > 0 ? norm : 1);
}

bool believable(double error, double rounding, const Vector& x, const Eigen::VectorXd& nu, const Goal& goal, bool finest)
{
  if (!goal.energy_norm || !std::isfinite(error) || error <= rounding) return true;
  return error <= goal.credible(finest) * goal.energy_norm(x, nu);
}

bool fits(const Solution& solution, const Goal& goal)
{
  return solution.projected_gradient <= limits::Every::largest_residual ||
         believable(solution.error, 0, solution.x, solution.nu, goal);
}

}  // namespace mortise::qp
