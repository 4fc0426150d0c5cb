// The table of solvers: each row solves the same programmes, and what passes from one algorithm to another.
#include "qp/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/dense.hpp"
#include "qp/norm.hpp"
#include "solver_setting.hpp"
#include "testing/rough_operator.hpp"

namespace mortise::qp {
namespace {

TEST(Solvers, NamesAreThoseOfTheDeckAndAutoBeginsWithTheFirst)
{
  std::set<std::string_view> names;
  for (const auto& kind : solvers()) {
    EXPECT_EQ(&solver_kind(kind.name), &kind);
    EXPECT_FALSE(kind.help.empty());
    names.insert(kind.name);
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"face_newton", "smalse", "direct"}));
  EXPECT_EQ(solver_kind("auto").name, "face_newton");
}

TEST(Solvers, EachSolvesWithGivenRadii)
{
  const Eigen::VectorXd exact = RandomProgramme().reference();
  int open = 0, slips = 0;  // the programme is worth solving
  for (Eigen::Index p = 0; p < exact.size(); p += 3) {
    open += exact[p] == 0;
    slips += exact.segment(p + 1, 2).norm() > (1 - 1e-12) * RandomProgramme::radius;
  }
  ASSERT_GE(open, 3);
  ASSERT_GE(slips, 3);
  for (const auto& kind : solvers()) {
    Setting setting;
    auto& [programme, budget, means] = setting;
    const auto solver = setting.make(kind);
    Goal goal{1e-10};
    std::optional<Solution> start;
    setting.begin(*solver, start, goal);
    const Solution solution = setting.solve(*solver, start, goal);
    ASSERT_TRUE(solution.feasible) << kind.name;
    EXPECT_TRUE(solution.converged) << kind.name;
    EXPECT_LT(programme.equality.norm(programme.equality.apply(solution.x) - programme.right.e), 1e-10) << kind.name;
    EXPECT_LT(kkt(solution, programme.problem), 1e-7) << kind.name;
    const Eigen::VectorXd x = gathered(solution.x, world());
    EXPECT_LT((x - exact).norm(), 1e-7 * exact.norm()) << kind.name;
  }
}

// Coulomb's law with the coefficients of a set as SlipLaw; radii are infinite to begin with.
SlipLaw coulomb(const FeasibleSet& set)
{
  return {[&set](const Vector* x) {
    std::vector<double> radii;
    for (const auto& disc : set.discs())
      radii.push_back(x ? disc.coefficient * std::max(view(*x)[disc.normal], 0.0) : std::numeric_limits<double>::infinity());
    return radii;
  }};
}

TEST(Solvers, ThoseThatFollowALawFulfilIt)
{
  int followed = 0;
  for (const auto& kind : solvers()) {
    Setting setting;
    auto& [programme, budget, means] = setting;
    // Normal and tangential unknowns of bodies have little to do with each other; those of a random matrix have.
    programme.dense += Eigen::MatrixXd::Identity(RandomProgramme::n, RandomProgramme::n);
    const DenseOperator a(programme.dense, programme.map, world());
    Hessian hessian(a, 20000);
    Budget own(hessian, {}, false);
    programme.set.set_coefficients(std::vector<double>(programme.set.discs().size(), 0.3));
    Eigen::VectorXd pressed = Eigen::VectorXd::Zero(RandomProgramme::n);  // feasible whatever the coefficient
    for (Eigen::Index i = 0; i < pressed.size(); i += 3) pressed[i] = 1;
    const RightHandSide right{programme.right.b, programme.g * pressed};
    const SlipLaw law = coulomb(programme.set);
    const Programme own_programme{hessian, programme.equality, programme.set};
    const auto solver = kind.make(own_programme, {own, nullptr, means.make_explicit});
    Goal goal{1e-9};
    std::optional<Solution> start;
    solver->begin(right, law.radii(nullptr), start, goal, {});
    const auto solution = solver->solve(right, law, start, goal, {});
    if (!solution) continue;
    ++followed;
    ASSERT_TRUE(solution->feasible) << kind.name;
    EXPECT_TRUE(solution->converged) << kind.name;
    const FeasibleSet set = programme.set.with_radii(law.radii(&solution->x));
    EXPECT_LT(kkt(*solution, {own_programme, right, set}), 1e-6) << kind.name;
    EXPECT_GE(world().sum(set.active(view(solution->x)).discs), 3) << kind.name;
  }
  EXPECT_EQ(followed, 2);  // SMALSE-M needs radii
}

// A residual that no arithmetic reaches: face Newton finds no better one, and SMALSE-M goes on from its last point.
TEST(Solvers, SmalseTakesOverWhereFaceNewtonCrawls)
{
  for (const bool waiting : {false, true}) {
    Setting setting;
    auto& programme = setting.programme;
    Budget budget(programme.hessian, 400, false);
    budget.start(waiting ? std::optional(390) : std::nullopt);
    const auto solver = solver_kind("face_newton").make(programme.programme, {budget, nullptr, {}});
    Goal goal{1e-18};
    std::optional<Solution> start;
    setting.begin(*solver, start, goal);
    int of_smalse = 0, of_faces = 0;  // outer steps
    const Solution solution = setting.solve(*solver, start, goal, [&](const Progress& progress) {
      if (progress.what == "outer") ++(progress.precision > 0 ? of_smalse : of_faces);
    });
    ASSERT_TRUE(solution.feasible);
    EXPECT_FALSE(solution.converged);
    EXPECT_GE(of_faces, 1);
    EXPECT_LE(of_faces, 60);
    if (waiting) {  // for the solve to give up, long before its products are spent
      EXPECT_EQ(of_smalse, 0);
      EXPECT_LE(programme.hessian.count(), 130);
    } else {
      EXPECT_GE(of_smalse, 1);
    }
    EXPECT_EQ(solution.outer_iterations, of_faces + of_smalse);
    EXPECT_LT(kkt(solution, programme.problem), 1e-8);  // what was reached stays
  }
}

// Face Newton finds nothing better than rough products allow; once they are exact, SMALSE-M goes on to the solution.
TEST(Solvers, SmalseConvergesAfterItHasTakenOver)
{
  Setting setting;
  auto& programme = setting.programme;
  RoughOperator a(programme.a, 1e-6);
  Hessian hessian(a, 4000);
  Budget budget(hessian, {}, false);
  budget.start(std::nullopt);
  const auto solver = solver_kind("face_newton").make({hessian, programme.equality, programme.set}, {budget, nullptr, {}});
  Goal goal{1e-8};
  std::optional<Solution> start;
  setting.begin(*solver, start, goal);
  int of_smalse = 0;  // outer steps
  const Solution solution = setting.solve(*solver, start, goal, [&](const Progress& progress) {
    if (progress.what != "outer" || !(progress.precision > 0)) return;
    ++of_smalse;
    a.exact = true;
  });
  EXPECT_GE(of_smalse, 2);
  EXPECT_LT(of_smalse, solution.outer_iterations);
  EXPECT_TRUE(solution.converged);
  // What rough products left in the gradient stays, since that is carried on.
  EXPECT_LT(kkt(solution, programme.problem), 1e-5);
  const Eigen::VectorXd exact = programme.reference();
  EXPECT_LT((gathered(solution.x, world()) - exact).norm(), 1e-5 * exact.norm());
}

// As many equations as unknowns: P A P is rounding, and steps over it would drown a small right-hand side.
TEST(Solvers, WhereTheEquationsLeaveNothingFreeTheyHoldToRounding)
{
  RandomProgramme programme;
  const auto map = even_map(6, world());
  const Eigen::MatrixXd root = programme.random(6, 6), dense = root * root.transpose() + Eigen::MatrixXd::Identity(6, 6);
  const Eigen::MatrixXd g = programme.random(6, 6) + 4 * Eigen::MatrixXd::Identity(6, 6);
  const Eigen::VectorXd e = 1e-9 * programme.random(6, 1);
  DenseOperator a(dense, map, world());
  const RightHandSide right{local_part(programme.random(6, 1), map), e};
  const EqualityConstraint equality(local_columns(g, *map), world());
  const FeasibleSet set;
  const Eigen::VectorXd eigenvalues = mortise::dense::symmetric_eigenvalues(dense);
  for (const auto* name : {"face_newton", "smalse"}) {
    Hessian hessian(a, 1000);
    const double norm = projected_norm(hessian, equality);
    EXPECT_GE(norm, 0.99 * eigenvalues[0]);
    EXPECT_LE(norm, 1.01 * eigenvalues[5]);
    Budget budget(hessian, {}, false);
    const auto solver = solver_kind(name).make({hessian, equality, set}, {budget, nullptr, {}});
    Goal goal{1e-8};
    std::optional<Solution> start;
    solver->begin(right, set.radii(), start, goal, {});
    const Solution solution = solver->solve(right, set.radii(), start, goal, {});
    EXPECT_TRUE(solution.converged) << name;
    EXPECT_LT((g * gathered(solution.x, world()) - e).norm(), 1e-13) << name;
    EXPECT_LT(kkt(solution, {{hessian, equality, set}, right, set}), 1e-7) << name;
  }
}

TEST(Solvers, HalfWayBackIsTheMeanOrTwiceAsFar)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> before{1, infinite, 0};
  EXPECT_EQ(half_way_back({3, 5, 4}, before), (std::vector<double>{2, 10, 2}));
}

}  // namespace
}  // namespace mortise::qp
