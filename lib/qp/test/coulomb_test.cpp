// Face Newton where the radii of discs follow other unknowns, and the active set that it then works on.
#include <gtest/gtest.h>

#include "random_programme.hpp"

namespace mortise::qp {
namespace {

constexpr double coefficient =
    0.3;  // active sets can take turns for ever with others; lib/friction then goes on by Tresca problems

std::vector<double> radii(const FeasibleSet& set, const Vector& x)
{
  std::vector<double> result;
  for (const auto& disc : set.discs()) result.push_back(coefficient * std::max(view(x)[disc.normal], 0.0));
  return result;
}

// A random programme with Coulomb's law, in which x with these three entries at each point is feasible. Normal and tangential
// unknowns of bodies have little to do with each other; those of a random matrix have, if its diagonal is not `heavier`.
struct WithCoulomb {
  WithCoulomb(int equations, const Eigen::Vector3d& inside, double heavier)
      : random(equations),
        right{random.right.b, random.g * inside.replicate(RandomProgramme::n / 3, 1)},
        a(random.dense + heavier * Eigen::MatrixXd::Identity(RandomProgramme::n, RandomProgramme::n), random.map, world())
  {
    random.set.set_coefficients(std::vector<double>(random.set.discs().size(), coefficient));
  }
  // Collective.
  Solution solve(const SlipLaw& law)
  {
    const std::vector<double> infinite(random.set.discs().size(), std::numeric_limits<double>::infinity());
    const Solution solution =
        FaceNewton({hessian, random.equality, random.set}, nullptr).solve(right, infinite, &law, {}, {1e-9, {}}, {});
    EXPECT_TRUE(solution.feasible);
    EXPECT_TRUE(solution.converged);
    const FeasibleSet set = random.set.with_radii(radii(random.set, solution.x));
    EXPECT_LT(kkt(solution, {{hessian, random.equality, random.set}, right, set}), 1e-6);
    const Eigen::Map<const Eigen::VectorXd> ended(solution.radii.data(), static_cast<Eigen::Index>(solution.radii.size()));
    const auto wanted = set.radii();
    const Eigen::Map<const Eigen::VectorXd> own(wanted.data(), ended.size());
    EXPECT_LT((ended - own).norm(), 1e-6 * (1 + own.norm()));  // the solution says which radii it ended with
    const auto active = set.active(view(solution.x));
    slipping = world().sum(active.discs);
    return solution;
  }

  RandomProgramme random;
  RightHandSide right;
  DenseOperator a;
  Hessian hessian{a, 20000};
  long long slipping = 0;
};

// At a solution every tangential unknown lies in the disc that its own normal unknown gives, and the KKT conditions hold there.
TEST(Coulomb, RadiiBelongToTheSolution)
{
  WithCoulomb programme(5, {1, 0, 0}, 1);  // feasible whatever the coefficient
  programme.solve({[&](const Vector* x) { return radii(programme.random.set, *x); }});
  EXPECT_LE(programme.hessian.count(), 60);
  EXPECT_GE(programme.slipping, 3);  // else this tells nothing
}

// So many equations that radii of the first normal unknowns leave no feasible point: half the way back to infinite ones, twice
// the radii, as often as it takes. The solution is one of the law.
TEST(Coulomb, RadiiThatLeaveNothingGoBack)
{
  WithCoulomb programme(30, {1, 0.12, -0.16}, 4);  // 0.2 of 0.3
  const auto& [random, right, a, hessian, slipping] = programme;
  bool nothing_left = false;
  const Solution solution = programme.solve({[&](const Vector* x) {
    auto wanted = radii(random.set, *x);
    if (!project(*x, random.equality, right.e, random.set.with_radii(wanted)).found) nothing_left = true;
    return wanted;
  }});
  EXPECT_TRUE(nothing_left);
  EXPECT_LT((random.g * gathered(solution.x, world()) - right.e).norm(), 1e-8);
}

// Where a disc slips whose radius follows x[normal], what moves goes along with it: x_t . n = coefficient x[normal].
TEST(ActiveSet, WhatMovesKeepsToTheLawOfFriction)
{
  RandomProgramme programme;
  auto& set = programme.set;
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  Projector projector(programme.equality, set);
  Vector argument = local_part(10 * programme.random(RandomProgramme::n, 1), programme.map);
  const std::vector<double> stiffness(set.discs().size(), 1.0);
  const ActiveSet active_set(projector, set, argument, 1, stiffness, 0, true);
  Vector moved = local_part(programme.random(RandomProgramme::n, 1), programme.map), constrained(programme.map);
  active_set.project_trial(moved, constrained);
  EXPECT_LT(programme.equality.norm(programme.equality.apply(moved)), 1e-11);
  const auto x = view(std::as_const(moved));
  const auto w = view(std::as_const(argument));
  long long following = 0;
  for (const auto& disc : set.discs()) {
    const Eigen::Vector2d tangential(w[disc.index[0]], w[disc.index[1]]);
    if (w[disc.normal] <= 0) {
      EXPECT_EQ(x[disc.normal], 0);
    } else if (tangential.norm() > disc.radius) {
      const double along = (x[disc.index[0]] * tangential[0] + x[disc.index[1]] * tangential[1]) / tangential.norm();
      EXPECT_NEAR(along, coefficient * x[disc.normal], 1e-12);
      ++following;
    }
  }
  EXPECT_GE(world().sum(following), 3);
  const auto keep_constrained = [&](Vector& of) {
    Vector result(of.getMap());
    active_set.add_constrained(1, of, result);
    of.assign(result);
  };
  constrained.assign(moved);
  keep_constrained(constrained);
  EXPECT_LT(constrained.normInf(), 1e-12);

  // What leads off the constraints stays as it is wanted.
  Vector wanted = local_part(programme.random(RandomProgramme::n, 1), programme.map);
  keep_constrained(wanted);
  EXPECT_GT(wanted.norm2(), 0.1);
  active_set.project_trial(moved, wanted);
  EXPECT_LT(programme.equality.norm(programme.equality.apply(moved)), 1e-11);
  keep_constrained(moved);
  moved.update(-1, wanted, 1);
  EXPECT_LT(moved.normInf(), 1e-12);
}

}  // namespace
}  // namespace mortise::qp
