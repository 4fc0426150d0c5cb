#include "qp/error_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "qp/projection.hpp"

namespace mortise::qp {

double error_estimate(const Problem& problem, const Solution& solution, const Operator* preconditioner)
{
  const double norm = solution.hessian_norm > 0 ? solution.hessian_norm : 1;
  Vector residual(solution.x, Teuchos::Copy);
  residual.update(-1 / norm, solution.gradient, 1);
  const Projection natural = project(residual, problem.equality, problem.set);
  residual.update(norm, solution.x, -norm, natural.point, 0);
  if (!preconditioner) return residual.norm2() / std::sqrt(norm);
  Vector z(residual.getMap());
  preconditioner->apply(residual, z);
  return std::sqrt(std::max(residual.dot(z), 0.0));
}

}  // namespace mortise::qp
