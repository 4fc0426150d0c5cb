#include "equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace mortise::friction {

bool fall_short(const qp::Projection& nearest)
{
  constexpr double rounding_of_balance = 1e-4;
  return nearest.empty || nearest.residual > rounding_of_balance;
}

void no_equilibrium(const feti::DualProblem& problem, const Eigen::VectorXd& nu, bool proven)
{
  if (!proven)
    throw Error(
        ExitStatus::bad_input,
        "no forces were found that balance the loads, though nothing proves that there are none: " +
            problem.unbounded_rigid_mode(nu) +
            " nearly freely. Support that body, or look at the direction of the loads, of which a small part may drive it, "
            "and at the units of young_modulus and of sizes: stiffnesses that differ by 1e12 are too far apart for rounding");
  throw Error(ExitStatus::no_equilibrium, "no equilibrium: " + problem.unbounded_rigid_mode(nu) +
                                              "; contacts can only push and friction is limited, so nothing holds it against "
                                              "the loads. Support it, or look at the direction of the loads and at the friction");
}

void nothing_found(const feti::DualProblem& problem, const qp::FeasibleSet& set, const Eigen::VectorXd& escape, bool proven)
{
  if (proven) no_equilibrium(problem, escape, true);
  const Vector nothing(problem.jump().rows());
  const auto right = problem.right_hand_side();
  qp::Projector projector(problem.equality(), set);
  qp::Projection nearest = projector(nothing, right->e, set);
  if (!nearest.empty) projector.prove_empty(right->e, set, nearest);
  no_equilibrium(problem, nearest.empty ? nearest.nu : escape, fall_short(nearest));
}

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
    no_equilibrium(problem, given.empty ? given.nu : nearest.nu, true);
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
  if (nearest.empty) no_equilibrium(problem, nearest.nu, true);
}

}  // namespace

void refuse_if_far(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws, const Vector& x,
                   double response)
{
  constexpr double little = 0.3;  // of an answer
  refuse_if_short(problem, set, laws, x, response < little ? 2e-3 : 0.05);
}

void refuse_if_sliding(const feti::DualProblem& problem, const qp::FeasibleSet& set, const std::vector<Law>& laws,
                       const Vector& x)
{
  refuse_if_short(problem, set, laws, x, 1e-4);
}

}  // namespace mortise::friction
