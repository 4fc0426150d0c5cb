#include "equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace mortise::friction {

namespace {

// The forces nearest to x that balance the loads and lie in `set`.
qp::Projection nearest_in(const qp::FeasibleSet& set, const feti::DualProblem& problem, const Vector& x)
{
  return qp::project(x, problem.equality(), problem.right_hand_side()->e, set);
}

}  // namespace

void judge_by_law(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws,
                  qp::Hessian& hessian, qp::Solution& solution)
{
  const qp::Projection nearest = nearest_in(set.with_cones(), problem, solution.x);
  if (nearest.empty) {  // with bounds that are given bodies slide; along the edge of a cone they would also lift
    const auto of_forces = set.with_radii(problem.radii(slip_bounds(problem, laws, &solution.x)));
    const qp::Projection given = nearest_in(of_forces, problem, solution.x);
    feti::no_equilibrium(problem, given.empty ? given.nu : nearest.nu, true);
  }
  Vector beyond(solution.x, Teuchos::Copy), product(beyond.getMap());
  beyond.update(-1, nearest.point, 1);
  hessian.apply(beyond, product);
  solution.error += std::sqrt(std::max(beyond.dot(product), 0.0));
}

bool balances(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<double>& radii, const Vector& x)
{
  constexpr double rounding = 1e-3;
  auto larger = radii;
  for (auto& radius : larger) radius *= 1 + rounding;
  return !nearest_in(set.with_radii(larger), problem, x).empty;
}

namespace {

// Throws if bounds that are larger than those at x by a part do not balance the loads.
void refuse_if_short(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws, const Vector& x,
                     double short_of)
{
  auto larger = problem.radii(slip_bounds(problem, laws, &x));
  for (auto& radius : larger) radius *= 1 + short_of;
  const qp::Projection nearest = nearest_in(set.with_radii(larger), problem, x);
  if (nearest.empty) feti::no_equilibrium(problem, nearest.nu, true);
}

}  // namespace

void refuse_if_far(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws, const Vector& x,
                   const std::optional<double>& response)
{
  constexpr double little = 0.3;  // of an answer
  refuse_if_short(problem, set, laws, x, response && *response < little ? 2e-3 : 0.05);
}

void refuse_if_sliding(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws,
                       const Vector& x)
{
  refuse_if_short(problem, set, laws, x, 1e-4);
}

}  // namespace mortise::friction
