// The table of solvers: each row solves the same programmes, and what passes from one algorithm to another.
#include "qp/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/dense.hpp"
#include "qp/condensed_newton.hpp"
#include "qp/norm.hpp"
#include "random_programme.hpp"
#include "testing/rough_operator.hpp"

namespace mortise::qp {
namespace {

// The matrices of a random programme, whole on every rank.
class DenseProgramme : public ActiveSetPreconditioner {
 public:
  // `compliance` on the diagonal is none of A.
  explicit DenseProgramme(RandomProgramme& programme, double compliance = 0) : programme_(programme), compliance_(compliance) {}
  Teuchos::RCP<const Map> getDomainMap() const override { return programme_.map; }
  Teuchos::RCP<const Map> getRangeMap() const override { return programme_.map; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const override
  {
    const Eigen::VectorXd whole = programme_.dense.llt().solve(gathered(*x.getVector(0), world()));
    y.getVectorNonConst(0)->update(alpha, local_part(whole, programme_.map), beta);
  }
  void fix(std::span<const Local>, std::span<const SlipDirection>) override {}

  ExplicitProgramme::Result solve(const RightHandSide& right) const { return solve(right.b, right.e, nullptr); }
  ExplicitProgramme::Result solve(const Vector& b, const Eigen::VectorXd& e, const ExplicitProgramme::Result* near) const
  {
    FeasibleSet set = RandomProgramme::bounds_and_discs(RandomProgramme::n);  // of all ranks: all discs are alike
    const auto discs = programme_.set.discs();
    set.set_coefficients(std::vector<double>(set.discs().size(), discs.front().coefficient));
    constexpr auto n = RandomProgramme::n;
    const CondensedNewton newton(programme_.dense + compliance_ * Eigen::MatrixXd::Identity(n, n), programme_.g,
                                 Eigen::MatrixXd::Zero(programme_.g.rows(), programme_.g.rows()), set);
    CondensedNewton::Result from;
    if (near) from = {gathered(near->x, world()), near->nu, true, 0, gathered(*near->reaction, world())};
    const auto found = newton.solve(gathered(b, world()), e, set, near ? &from : nullptr);
    return {local_part(found.x, programme_.map), found.nu, found.converged, local_part(found.reaction, programme_.map)};
  }

 private:
  RandomProgramme& programme_;
  double compliance_;
};

struct Setting {
  RandomProgramme programme;
  Budget budget{programme.hessian, {}, false};
  Means means{budget, nullptr, [this] {
                auto matrices = std::make_shared<DenseProgramme>(programme);
                return ExplicitProgramme{
                    matrices, [matrices](const RightHandSide& right, const FeasibleSet&) { return matrices->solve(right); }};
              }};
  std::unique_ptr<Solver> make(const SolverKind& kind) { return kind.make(programme.programme, means); }
  // With the radii that the programme has. Collective.
  void begin(Solver& solver, std::optional<Solution>& start, Goal& goal, const Observer& observer = {}) const
  {
    solver.begin(programme.right, programme.set.radii(), start, goal, observer);
  }
  Solution solve(Solver& solver, const std::optional<Solution>& start, const Goal& goal, const Observer& observer = {}) const
  {
    return solver.solve(programme.right, programme.set.radii(), start, goal, observer);
  }
};

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

// An exact start needs no more than what shows that it is one.
TEST(Solvers, ADirectSolutionIsShownByAFewProducts)
{
  Setting setting;
  const auto solver = setting.make(solver_kind("direct"));
  Goal goal{1e-8};
  std::optional<Solution> start;
  std::vector<std::string> steps;
  const Observer observer = [&](const Progress& progress) { steps.push_back(progress.what); };
  setting.begin(*solver, start, goal, observer);
  ASSERT_TRUE(start);
  EXPECT_EQ(steps, std::vector<std::string>{"direct"});
  EXPECT_EQ(setting.programme.hessian.count(), 0);
  EXPECT_TRUE(setting.solve(*solver, start, goal, observer).converged);
  EXPECT_LE(setting.programme.hessian.count(), 24);  // up to 20 of them for the norm
}

// A matrix with a compliance that A has not: each product leaves so much less of what it makes of the solution.
TEST(Solvers, ANearbyMatrixIsCorrectedByAFewProducts)
{
  const auto solve = [](Setting& setting) {
    const auto solver = setting.make(solver_kind("direct"));
    Goal goal{1e-12};
    std::optional<Solution> start;
    setting.begin(*solver, start, goal);
    return gathered(start->x, world());
  };
  Setting exact, nearby;
  nearby.means.make_explicit = [&nearby] {
    const auto matrices = std::make_shared<DenseProgramme>(nearby.programme, 1e-5);
    ExplicitProgramme programme{matrices,
                                [matrices](const RightHandSide& right, const FeasibleSet&) { return matrices->solve(right); }};
    programme.go_on = [matrices](const RightHandSide&, const Vector& b, const Eigen::VectorXd& e, const FeasibleSet&,
                                 const ExplicitProgramme::Result& near) { return matrices->solve(b, e, &near); };
    programme.differs = true;
    return programme;
  };
  const Eigen::VectorXd expected = solve(exact), x = solve(nearby);
  EXPECT_EQ(exact.programme.hessian.count(), 0);
  EXPECT_LE(nearby.programme.hessian.count(), 5);
  EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
}

// A load step begins with the states at the end of the last one; where these lead nowhere it begins anew.
TEST(Solvers, ADirectSolutionBeginsWithTheStatesBefore)
{
  for (const bool lead_on : {true, false}) {
    Setting setting;
    int anew = 0, on = 0;
    setting.means.make_explicit = [&] {
      const auto matrices = std::make_shared<DenseProgramme>(setting.programme);
      ExplicitProgramme programme{
          matrices, [&anew, matrices](const RightHandSide& right, const FeasibleSet&) { return ++anew, matrices->solve(right); }};
      programme.go_on = [&, matrices](const RightHandSide&, const Vector& b, const Eigen::VectorXd& e, const FeasibleSet&,
                                      const ExplicitProgramme::Result& near) {
        ++on;
        auto found = matrices->solve(b, e, &near);
        EXPECT_TRUE(found.converged);
        found.converged = lead_on;
        return found;
      };
      return programme;
    };
    const auto solver = setting.make(solver_kind("direct"));
    Goal goal{1e-10};
    std::optional<Solution> start;
    setting.begin(*solver, start, goal);
    EXPECT_EQ(on, 0);
    start = setting.solve(*solver, start, goal);
    RightHandSide next{Vector(setting.programme.right.b, Teuchos::Copy), setting.programme.right.e};
    next.b.scale(1.1);
    const auto radii = setting.programme.set.radii();
    solver->begin(next, radii, start, goal, {});
    EXPECT_EQ(on, 1);
    EXPECT_EQ(anew, lead_on ? 1 : 2);
    const auto expected = DenseProgramme(setting.programme).solve(next);
    EXPECT_LT((gathered(start->x, world()) - gathered(expected.x, world())).norm(), 1e-8 * gathered(expected.x, world()).norm());
    EXPECT_TRUE(solver->solve(next, radii, start, goal, {}).converged);
  }
}

// Matrices whose solution is none, or one whose states rest on rounding, give way to others that have one, and to no others.
// Where nothing has converged faces begin by themselves.
TEST(Solvers, OtherMatricesFollowThoseThatFail)
{
  struct Outcome {
    bool converged, settled;
  };
  const auto solve = [](Outcome first, Outcome second) {
    Setting setting;
    const auto programme_with = [&setting](Outcome outcome, double scale) {
      const auto matrices = std::make_shared<DenseProgramme>(setting.programme);
      return ExplicitProgramme{matrices, [matrices, outcome, scale](const RightHandSide& right, const FeasibleSet&) {
                                 auto found = matrices->solve(right);
                                 found.x.scale(scale);
                                 found.converged = outcome.converged;
                                 found.settled = outcome.settled;
                                 return found;
                               }};
    };
    setting.means.make_explicit = [&] {
      auto programme = programme_with(first, 1);
      programme.instead = [&] { return programme_with(second, 2); };
      return programme;
    };
    const auto solver = setting.make(solver_kind("direct"));
    Goal goal{1e-12};
    std::optional<Solution> start;
    setting.begin(*solver, start, goal);
    return start ? gathered(start->x, world()).norm() : 0;
  };
  const double first = solve({true, true}, {true, true}), second = solve({false, true}, {true, true});
  EXPECT_NEAR(second, 2 * first, 1e-12 * first);
  EXPECT_NEAR(solve({true, false}, {true, true}), second, 1e-12 * first);
  EXPECT_NEAR(solve({false, false}, {true, false}), second, 1e-12 * first);
  EXPECT_NEAR(solve({true, false}, {true, false}), first, 1e-12 * first);
  EXPECT_NEAR(solve({true, false}, {false, true}), first, 1e-12 * first);
  EXPECT_EQ(solve({false, true}, {false, true}), 0);  // no start
}

// States that another way suggests come first where there is no solution before.
TEST(Solvers, ADirectSolutionBeginsWithTheStatesThatAreSuggested)
{
  for (const bool lead_on : {true, false}) {
    Setting setting;
    const auto& right = setting.programme.right;
    int anew = 0, on = 0;
    const DenseProgramme suggests(setting.programme);
    const auto states = suggests.solve(right);
    setting.means.make_explicit = [&] {
      const auto matrices = std::make_shared<DenseProgramme>(setting.programme);
      ExplicitProgramme programme{
          matrices, [&anew, matrices](const RightHandSide& given, const FeasibleSet&) { return ++anew, matrices->solve(given); }};
      programme.go_on = [&, matrices](const RightHandSide&, const Vector& b, const Eigen::VectorXd& e, const FeasibleSet&,
                                      const ExplicitProgramme::Result& near) {
        ++on;
        EXPECT_FALSE(near.converged);
        EXPECT_EQ(gathered(near.x, world()), gathered(states.x, world()));
        EXPECT_EQ(gathered(*near.reaction, world()), gathered(*states.reaction, world()));
        auto found = matrices->solve(b, e, nullptr);
        found.converged = lead_on;
        return found;
      };
      return programme;
    };
    const auto solver = setting.make(solver_kind("direct"));
    Goal goal{1e-10};
    std::optional<Solution> start;
    const Solution suggested(states.x, *states.reaction, states.nu);
    solver->begin(right, setting.programme.set.radii(), start, goal, {}, &suggested);
    EXPECT_EQ(on, 1);
    EXPECT_EQ(anew, lead_on ? 0 : 1);
    ASSERT_TRUE(start);
    EXPECT_EQ(gathered(start->x, world()), gathered(states.x, world()));
  }
}

// Matrices that are better than products have their solution judged by its defect: one product, and the next solve is done.
TEST(Solvers, AJudgedSolutionIsTheAnswerToOneSolve)
{
  for (const bool by_law : {false, true}) {
    Setting setting;
    auto& programme = setting.programme;
    setting.means.make_explicit = [&] {
      const auto matrices = std::make_shared<DenseProgramme>(programme);
      ExplicitProgramme result{matrices,
                               [matrices](const RightHandSide& right, const FeasibleSet&) { return matrices->solve(right); }};
      result.rough_products = true;
      return result;
    };
    const auto solver = setting.make(solver_kind("direct"));
    const auto radii = programme.set.radii();
    const SlipLaw law{[&radii](const Vector*) { return radii; }};
    Goal goal{1e-8};
    goal.allowed_error = [](const Vector&, const Eigen::VectorXd&) { return 1e-6; };
    goal.energy_norm = [&](const Vector& x, const Eigen::VectorXd&) { return programme.distance(x, 0 * gathered(x, world())); };
    std::optional<Solution> start;
    Foreknown known = solver->begin(programme.right, radii, start, goal, {});
    EXPECT_EQ(programme.hessian.count(), 1);
    ASSERT_TRUE(known.answer);
    const auto solve = [&] {
      return by_law ? *solver->solve(programme.right, law, start, goal, {}, &known)
                    : solver->solve(programme.right, radii, start, goal, {}, &known);
    };
    const Eigen::VectorXd exact = programme.reference();
    for (const bool first : {true, false}) {
      const Solution solution = solve();
      EXPECT_EQ(programme.hessian.count() == 1, first);
      EXPECT_FALSE(known.answer);
      EXPECT_TRUE(solution.converged);
      EXPECT_EQ(solution.radii, radii);
      EXPECT_LT(programme.distance(solution.x, exact), 1e-6);
    }
  }
}

// Where products are too rough for faces to settle contact, what the matrices found is judged in place of their last point.
TEST(Solvers, ASolutionByMatricesIsJudgedWhereFacesDoNotConverge)
{
  for (const bool pass_on : {false, true}) {
    Setting setting;
    auto& programme = setting.programme;
    const RoughOperator rough(programme.a, 1e-5);
    Hessian hessian(rough, 4000);
    Budget budget(hessian, {}, false);
    budget.start(Patience(390));  // SMALSE-M is not to go on
    const auto solver =
        solver_kind("direct").make({hessian, programme.equality, programme.set}, {budget, nullptr, setting.means.make_explicit});
    const auto radii = programme.set.radii();
    Goal goal{1e-8};
    goal.allowed_error = [](const Vector&, const Eigen::VectorXd&) { return 1e-3; };
    goal.energy_norm = [&](const Vector& x, const Eigen::VectorXd&) { return programme.distance(x, 0 * gathered(x, world())); };
    goal.contact_converged = [](const Vector&, const Vector&, const Vector&) { return false; };
    std::optional<Solution> start;
    Foreknown known = solver->begin(programme.right, radii, start, goal, {});
    ASSERT_TRUE(known.by_matrices);
    EXPECT_FALSE(known.answer);
    const auto solution = solver->solve(programme.right, radii, start, goal, {}, pass_on ? &known : nullptr);
    EXPECT_EQ(solution.converged, pass_on);
    if (pass_on) EXPECT_EQ(gathered(solution.x, world()), gathered(known.by_matrices->x, world()));
  }
}

// That bodies slide on for ever is told to who follows a law, and once; with radii that are given there is a solution.
TEST(Solvers, ThatBodiesSlideIsToldToALawOnce)
{
  Setting setting;
  auto& programme = setting.programme;
  setting.means.make_explicit = [&] {
    const auto matrices = std::make_shared<DenseProgramme>(programme);
    return ExplicitProgramme{matrices, [matrices](const RightHandSide& right, const FeasibleSet&) {
                               auto found = matrices->solve(right);
                               found.converged = false;
                               found.slides = true;
                               return found;
                             }};
  };
  const auto solver = setting.make(solver_kind("direct"));
  const auto radii = programme.set.radii();
  const SlipLaw law{[&radii](const Vector*) { return radii; }};
  Goal goal{1e-8};
  std::optional<Solution> start;
  Foreknown known = solver->begin(programme.right, radii, start, goal, {});
  EXPECT_FALSE(start);
  EXPECT_TRUE(solver->solve(programme.right, radii, start, goal, {}, &known).converged);
  const auto told = solver->solve(programme.right, law, start, goal, {}, &known);
  ASSERT_TRUE(told);
  EXPECT_TRUE(told->slides);
  EXPECT_FALSE(told->feasible);
  EXPECT_EQ(told->radii, radii);
  const auto next = solver->solve(programme.right, law, start, goal, {}, &known);
  ASSERT_TRUE(next);
  EXPECT_FALSE(next->slides);
  EXPECT_TRUE(next->feasible);
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
