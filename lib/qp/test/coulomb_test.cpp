// Face Newton where the radii of discs follow other unknowns, and the active set that it then works on.
#include <gtest/gtest.h>

#include "qp/face_newton.hpp"
#include "qp/solver.hpp"
#include "random_programme.hpp"

namespace mortise::qp {
namespace {

std::vector<double> radii(const FeasibleSet& set, const Vector& x)
{
  std::vector<double> result;
  for (const auto& disc : set.discs()) result.push_back(disc.coefficient * std::max(view(x)[disc.normal], 0.0));
  return result;
}

// Coulomb's law: radii that the normal unknowns ask for.
class CoulombRenewal {
 public:
  explicit CoulombRenewal(FeasibleSet& set) : set_(set) {}
  SlipBoundUpdate slip_bound_update()
  {
    return {[this](const Vector& x, bool apply) { return update(x, apply); }, [] {}};
  }

 private:
  double update(const Vector& x, bool apply)
  {
    const auto wanted = radii(set_, x);
    double square = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) square += std::pow(wanted[i] - set_.discs()[i].radius, 2);
    if (apply) set_.set_radii(wanted);
    return std::sqrt(world().sum(square));
  }
  FeasibleSet& set_;
};

// At a solution every tangential unknown lies in the disc that its own normal unknown gives, and the KKT conditions hold there.
TEST(Coulomb, RadiiBelongToTheSolution)
{
  constexpr double coefficient =
      0.3;  // active sets can take turns for ever with others; lib/friction then goes on by Tresca problems
  RandomProgramme programme;
  auto& set = programme.set;
  Eigen::VectorXd pressed = Eigen::VectorXd::Zero(RandomProgramme::n);  // feasible whatever the coefficient
  for (Eigen::Index i = 0; i < pressed.size(); i += 3) pressed[i] = 1;
  programme.equality.set_right_side(programme.g * pressed);
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  set.set_radii(std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()));
  CoulombRenewal law(set);
  const SlipBoundUpdate slip_bound_update = law.slip_bound_update();
  // Normal and tangential unknowns of bodies have little to do with each other; those of a random matrix have.
  const Eigen::MatrixXd dense = programme.dense + Eigen::MatrixXd::Identity(RandomProgramme::n, RandomProgramme::n);
  const DenseOperator a(dense, programme.map, world());
  Hessian hessian(a, 20000);
  const Problem problem{hessian, programme.b, programme.equality, set};
  const Solution solution = FaceNewton(problem, nullptr).solve({}, {1e-9, {}}, &slip_bound_update, {});
  ASSERT_TRUE(solution.feasible);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(hessian.count(), 60);
  set.set_radii(radii(set, solution.x));
  EXPECT_LT(kkt(solution, problem), 1e-6);
  const auto active = set.active(view(solution.x));
  EXPECT_GE(world().sum(active.discs), 3);  // else nothing slips, and this tells nothing
}

// So many equations that radii of the first normal unknowns leave no feasible point: half the way back to infinite ones, twice
// the radii, as often as it takes. The solution is one of the law.
TEST(Coulomb, RadiiThatLeaveNothingGoBack)
{
  constexpr double coefficient = 0.3;
  RandomProgramme programme(30);
  auto& set = programme.set;
  Eigen::VectorXd within = Eigen::VectorXd::Zero(RandomProgramme::n);
  for (Eigen::Index i = 0; i < within.size(); i += 3) within.segment(i, 3) << 1, 0.12, -0.16;  // 0.2 of 0.3
  programme.equality.set_right_side(programme.g * within);
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  auto now = std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()), before = now;
  set.set_radii(now);
  int retreats = 0;
  const SlipBoundUpdate law{[&](const Vector& x, bool apply) {
                              const auto wanted = radii(set, x);
                              double square = 0;
                              for (std::size_t i = 0; i < wanted.size(); ++i)
                                square += std::pow(std::isinf(now[i]) ? 1.0 : wanted[i] - now[i], 2);
                              if (apply) {
                                before = std::exchange(now, wanted);
                                set.set_radii(now);
                              }
                              return std::sqrt(world().sum(square));
                            },
                            [&] {
                              ++retreats;
                              now = half_way_back(now, before);
                              set.set_radii(now);
                            }};
  const Eigen::MatrixXd dense = programme.dense + 4 * Eigen::MatrixXd::Identity(RandomProgramme::n, RandomProgramme::n);
  const DenseOperator a(dense, programme.map, world());
  Hessian hessian(a, 20000);
  const Problem problem{hessian, programme.b, programme.equality, set};
  const Solution solution = FaceNewton(problem, nullptr).solve({}, {1e-9, {}}, &law, {});
  EXPECT_GE(retreats, 1);
  ASSERT_TRUE(solution.feasible);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT((programme.g * gathered(solution.x, world()) - programme.equality.right_side()).norm(), 1e-8);
  set.set_radii(radii(set, solution.x));
  EXPECT_LT(kkt(solution, problem), 1e-6);
}

// Where a disc slips whose radius follows x[normal], what moves goes along with it: x_t . n = coefficient x[normal].
TEST(ActiveSet, WhatMovesKeepsToTheLawOfFriction)
{
  constexpr double coefficient = 0.4;
  RandomProgramme programme;
  auto& set = programme.set;
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  Projector projector(programme.equality, set);
  Vector argument = local_part(10 * programme.random(RandomProgramme::n, 1), programme.map);
  const std::vector<double> stiffness(set.discs().size(), 1.0);
  const ActiveSet active_set(projector, argument, 1, stiffness, 0, true);
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
  constrained.assign(moved);
  active_set.keep_constrained(constrained);
  EXPECT_LT(constrained.normInf(), 1e-12);

  // What leads off the constraints stays as it is wanted.
  Vector wanted = local_part(programme.random(RandomProgramme::n, 1), programme.map);
  active_set.keep_constrained(wanted);
  EXPECT_GT(wanted.norm2(), 0.1);
  active_set.project_trial(moved, wanted);
  EXPECT_LT(programme.equality.norm(programme.equality.apply(moved)), 1e-11);
  active_set.keep_constrained(moved);
  moved.update(-1, wanted, 1);
  EXPECT_LT(moved.normInf(), 1e-12);
}

}  // namespace
}  // namespace mortise::qp
