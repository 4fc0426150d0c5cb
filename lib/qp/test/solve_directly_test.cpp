// A direct solution as a start: what shows that it is one, what corrects it, and what takes its place where it is none.
#include <cmath>

#include "solver_setting.hpp"
#include "testing/rough_operator.hpp"

namespace mortise::qp {
namespace {

// A random programme with products that are off by so much of their size, `patience` of them, so that SMALSE-M does not go on.
// `at_once`: A x - b is exact.
struct RoughSetting : Setting {
  RoughSetting(double off, int patience, bool at_once = false)
      : rough(programme.a, off),
        hessian(rough, 4000, at_once ? exact_gradient() : Hessian::Gradient()),
        rough_budget(hessian, {}, false)
  {
    rough_budget.start(Patience(patience));
  }
  std::unique_ptr<Solver> make()
  {
    return solver_kind("direct").make({hessian, programme.equality, programme.set}, {rough_budget, nullptr, means.make_explicit});
  }
  Hessian::Gradient exact_gradient()
  {
    return [this](const Vector& x, const RightHandSide& right, Vector& result) {
      result.assign(right.b);
      programme.a.apply(x, result, Teuchos::NO_TRANS, 1, -1);
    };
  }

  RoughOperator rough;
  Hessian hessian;
  Budget rough_budget;
};

// An exact start needs no more than what shows that it is one.
TEST(DirectSolver, IsShownByAFewProducts)
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
TEST(DirectSolver, CorrectsANearbyMatrixByAFewProducts)
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
    auto programme = nearby.explicit_programme({}, 1e-5);
    const auto matrices = std::make_shared<DenseProgramme>(nearby.programme, 1e-5);
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
TEST(DirectSolver, BeginsWithTheStatesBefore)
{
  for (const bool lead_on : {true, false}) {
    Setting setting;
    int anew = 0, on = 0;
    setting.means.make_explicit = [&] {
      auto programme = setting.explicit_programme([&anew](ExplicitProgramme::Result&) { ++anew; });
      programme.go_on = [&](const RightHandSide&, const Vector& b, const Eigen::VectorXd& e, const FeasibleSet&,
                            const ExplicitProgramme::Result& near) {
        ++on;
        auto found = DenseProgramme(setting.programme).solve(b, e, &near);
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
TEST(DirectSolver, TakesOtherMatricesAfterThoseThatFail)
{
  struct Outcome {
    bool converged, settled;
  };
  const auto solve = [](Outcome first, Outcome second, bool instead_of_none = false) {
    Setting setting;
    const auto programme_with = [&setting](Outcome outcome, double scale) {
      return setting.explicit_programme([outcome, scale](ExplicitProgramme::Result& found) {
        found.x.scale(scale);
        found.converged = outcome.converged;
        found.settled = outcome.settled;
      });
    };
    setting.means.make_explicit = [&] {
      auto programme = programme_with(first, 1);
      programme.instead = [&] { return programme_with(second, 2); };
      programme.instead_of_none = instead_of_none;
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
  EXPECT_NEAR(solve({true, false}, {true, true}, true), first, 1e-12 * first);
  EXPECT_NEAR(solve({false, false}, {true, false}, true), second, 1e-12 * first);
}

// States that another way suggests come first where there is no solution before.
TEST(DirectSolver, BeginsWithTheStatesThatAreSuggested)
{
  for (const bool lead_on : {true, false}) {
    Setting setting;
    const auto& right = setting.programme.right;
    int anew = 0, on = 0;
    const DenseProgramme suggests(setting.programme);
    const auto states = suggests.solve(right);
    setting.means.make_explicit = [&] {
      auto programme = setting.explicit_programme([&anew](ExplicitProgramme::Result&) { ++anew; });
      programme.go_on = [&](const RightHandSide&, const Vector& b, const Eigen::VectorXd& e, const FeasibleSet&,
                            const ExplicitProgramme::Result& near) {
        ++on;
        EXPECT_FALSE(near.converged);
        EXPECT_EQ(gathered(near.x, world()), gathered(states.x, world()));
        EXPECT_EQ(gathered(*near.reaction, world()), gathered(*states.reaction, world()));
        auto found = suggests.solve(b, e, nullptr);
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
TEST(DirectSolver, AnswersOneSolveWithAJudgedSolution)
{
  for (const bool by_law : {false, true}) {
    Setting setting;
    auto& programme = setting.programme;
    setting.means.make_explicit = [&] {
      auto result = setting.explicit_programme();
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
TEST(DirectSolver, JudgesTheSolutionByMatricesWhereFacesDoNotConverge)
{
  for (const bool pass_on : {false, true}) {
    RoughSetting setting(1e-5, 390);
    auto& programme = setting.programme;
    const auto solver = setting.make();
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

// A residual that is asked for and that rounding of products does not let come down: the error, which matrices tell, ends it.
TEST(DirectSolver, EndsWhereRoundingKeepsTheResidual)
{
  for (const double off : {1e-9, 1e-2}) {
    RoughSetting setting(off, 1500);
    auto& programme = setting.programme;
    const auto solver = setting.make();
    Goal goal{1e-14};
    goal.energy_norm = [&](const Vector& x, const Eigen::VectorXd&) { return programme.distance(x, 0 * gathered(x, world())); };
    const auto radii = programme.set.radii();
    std::optional<Solution> start;
    Foreknown known = solver->begin(programme.right, radii, start, goal, {});
    const auto solution = solver->solve(programme.right, radii, start, goal, {}, &known);
    EXPECT_EQ(solution.converged, off < 1e-6);
    if (off > 1e-6) continue;
    EXPECT_LT(setting.hessian.count(), 300);
    EXPECT_GT(solution.projected_gradient, goal.residual);
    EXPECT_LT(programme.distance(solution.x, programme.reference()), 1e-6 * goal.energy_norm(solution.x, solution.nu));
  }
}

// Where A x and b lose what their difference has, who makes that at once tells how good a solution by matrices is.
TEST(DirectSolver, KnowsItsDefectFromWhoMakesItAtOnce)
{
  for (const bool at_once : {false, true}) {
    RoughSetting setting(1e-2, 390, at_once);
    auto& programme = setting.programme;
    setting.means.make_explicit = [&] {
      auto result = setting.explicit_programme();
      result.rough_products = true;
      return result;
    };
    const auto solver = setting.make();
    const auto radii = programme.set.radii();
    Goal goal{1e-8};
    goal.allowed_error = [](const Vector&, const Eigen::VectorXd&) { return 1e-6; };
    goal.energy_norm = [&](const Vector& x, const Eigen::VectorXd&) { return programme.distance(x, 0 * gathered(x, world())); };
    std::optional<Solution> start;
    const Foreknown known = solver->begin(programme.right, radii, start, goal, {});
    EXPECT_EQ(known.answer.has_value(), at_once);
    if (!at_once) continue;
    EXPECT_EQ(setting.hessian.count(), 1);
    EXPECT_LT(programme.distance(known.answer->x, programme.reference()), 1e-6);
  }
}

// A^-1 that feels hardly anything.
class NumbInverse : public DenseProgramme {
 public:
  using DenseProgramme::DenseProgramme;
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override
  {
    DenseProgramme::apply(x, y, mode, 1e-20 * alpha, beta);
  }
};

// Adds to the reaction what no state of a constraint has: a defect.
void spoil(ExplicitProgramme::Result& found, double size)
{
  Vector more(found.x.getMap());
  for (std::size_t i = 0; i < more.getLocalLength(); ++i)
    view(more)[static_cast<Eigen::Index>(i)] = size * std::cos(3.0 * static_cast<double>(i));
  found.reaction->update(1, more, 1);
}

// Where the first matrices are the better ones, they judge what others found in their place.
TEST(DirectSolver, LetsTheBetterMatricesJudge)
{
  for (const bool better : {false, true}) {
    RoughSetting setting(1e-5, 390);
    auto& programme = setting.programme;
    setting.means.make_explicit = [&] {
      auto first = setting.explicit_programme([](ExplicitProgramme::Result& found) { found.converged = false; });
      first.rough_products = better;
      first.instead = [&] {
        auto others = setting.explicit_programme([](ExplicitProgramme::Result& found) { spoil(found, 3e-3); });
        others.inverse = std::make_shared<NumbInverse>(programme);
        return others;
      };
      return first;
    };
    const auto solver = setting.make();
    Goal goal{1e-8};
    goal.allowed_error = [](const Vector&, const Eigen::VectorXd&) { return 1e-3; };
    goal.energy_norm = [&](const Vector& x, const Eigen::VectorXd&) { return programme.distance(x, 0 * gathered(x, world())); };
    goal.contact_converged = [](const Vector&, const Vector&, const Vector&) { return false; };
    const auto radii = programme.set.radii();
    std::optional<Solution> start;
    Foreknown known = solver->begin(programme.right, radii, start, goal, {});
    ASSERT_TRUE(known.by_matrices);
    EXPECT_EQ(solver->solve(programme.right, radii, start, goal, {}, &known).converged, !better);
  }
}

// A defect d counts by the least energy of d + G'nu.
TEST(DirectSolver, LeavesMotionsOutOfTheErrorOfSlenderBodies)
{
  Setting setting;
  auto& programme = setting.programme;
  setting.means.make_explicit = [&] {
    auto result = setting.explicit_programme([](ExplicitProgramme::Result& found) { spoil(found, 1e-3); });
    result.rough_products = true;
    return result;
  };
  const auto solver = setting.make(solver_kind("direct"));
  Goal goal{1e-8};
  goal.allowed_error = [](const Vector&, const Eigen::VectorXd&) { return 1.0; };
  goal.energy_norm = [&](const Vector& x, const Eigen::VectorXd&) { return programme.distance(x, 0 * gathered(x, world())); };
  std::optional<Solution> start;
  const auto known = solver->begin(programme.right, programme.set.radii(), start, goal, {});
  ASSERT_TRUE(known.answer);
  ExplicitProgramme::Result spoilt{Vector(programme.map), {}, true, Vector(programme.map)};
  spoil(spoilt, 1e-3);
  programme.equality.project(*spoilt.reaction);
  const Eigen::VectorXd d = gathered(*spoilt.reaction, world()), error = programme.dense.llt().solve(d);
  const Eigen::MatrixXd& g = programme.g;
  const Eigen::MatrixXd work = g * programme.dense.llt().solve(g.transpose());
  const Eigen::VectorXd felt = g * error;
  const double whole = d.dot(error), least = whole - felt.dot(work.llt().solve(felt));
  EXPECT_LT(least, 0.99 * whole);
  EXPECT_NEAR(known.answer->error, std::sqrt(least), 1e-4 * std::sqrt(least));
}

// That bodies slide on for ever is told to who follows a law, and once; with radii that are given there is a solution.
TEST(DirectSolver, TellsALawOnceThatBodiesSlide)
{
  Setting setting;
  auto& programme = setting.programme;
  setting.means.make_explicit = [&] {
    return setting.explicit_programme([](ExplicitProgramme::Result& found) {
      found.converged = false;
      found.slides = true;
    });
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

}  // namespace
}  // namespace mortise::qp
