#include "feti/no_equilibrium.hpp"

#include "base/error.hpp"

namespace mortise::feti {

bool fall_short(const qp::Projection& nearest)
{
  constexpr double rounding_of_balance = 1e-4;
  return nearest.empty || nearest.residual > rounding_of_balance;
}

void no_equilibrium(const DualProblem& problem, const Eigen::VectorXd& nu, bool proven)
{
  if (!proven)
    throw Error(
        ExitStatus::bad_input,
        "no forces were found that balance the loads, though nothing proves that there are none: " +
            problem.system().unbounded_rigid_mode(nu) +
            " nearly freely. Support that body, or look at the direction of the loads, of which a small part may drive it, "
            "and at the units of young_modulus and of sizes: stiffnesses that differ by 1e12 are too far apart for rounding");
  throw Error(ExitStatus::no_equilibrium, "no equilibrium: " + problem.system().unbounded_rigid_mode(nu) +
                                              "; contacts can only push and friction is limited, so nothing holds it against "
                                              "the loads. Support it, or look at the direction of the loads and at the friction");
}

void nothing_found(const DualProblem& problem, const qp::FeasibleSet& set, const Eigen::VectorXd& escape, bool proven)
{
  if (proven) no_equilibrium(problem, escape, true);
  const Vector nothing(problem.jump().rows());
  const auto right = problem.right_hand_side();
  qp::Projector projector(problem.equality(), set);
  qp::Projection nearest = projector(nothing, right->e, set);
  if (!nearest.empty) projector.prove_empty(right->e, set, nearest);
  no_equilibrium(problem, nearest.empty ? nearest.nu : escape, fall_short(nearest));
}

}  // namespace mortise::feti
