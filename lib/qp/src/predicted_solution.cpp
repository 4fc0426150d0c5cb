#include "qp/predicted_solution.hpp"

#include "qp/projection.hpp"

namespace mortise::qp {

std::optional<PredictedSolution> predict(const Problem& problem, const Solution& found, ActiveSetPreconditioner& preconditioner)
{
  const double norm = found.hessian_norm;
  if (!(norm > 0)) return {};
  Vector gap(found.x, Teuchos::Copy);
  gap.update(-1 / norm, found.gradient, 1);
  const Projection natural = project(gap, problem.equality, problem.right.e, problem.set);
  if (!natural.found) return {};
  gap.update(norm, found.x, -norm, natural.point, 0);
  PredictedSolution result{natural.argument, Vector(gap.getMap())};
  preconditioner.fix({}, {});
  preconditioner.apply(gap, result.change);
  return result;
}

}  // namespace mortise::qp
