// Load steps on two blocks, one on the other, where stresses, forces and slip are known. The same on any ranks.
#include <gtest/gtest.h>

#include "analysis/checks.hpp"
#include "analysis/load_step_solver.hpp"
#include "base/error.hpp"
#include "model/resolution.hpp"
#include "partition/decompose.hpp"
#include "testing/quiet.hpp"

namespace mortise::analysis {
namespace {

constexpr double young = 1000, pressure = 2, width = 1, height = 2;

// Two cubes, the upper one pressed and pushed; nothing contracts.
const std::string blocks = R"(
mesh:
  blocks:
    lower: {size: [1, 1, 1], cells: [2, 2, 2]}
    upper: {origin: [0, 0, 1], size: [1, 1, 1], cells: [2, 2, 2]}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0}}
bodies: {lower: {material: steel}, upper: {material: steel}}
decomposition: {method: grid, counts: {lower: [2, 1, 1], upper: [1, 2, 1]}}
solver: {algorithm: face_newton, tolerance: 1e-10}
friction_loop: {tolerance: 1e-10}
loads:
  - {name: press, boundary: upper.zmax, pressure: 2}
  - {name: push, boundary: upper.zmin, traction: [0.5, 0, 0]}
)";
const std::string supports = R"(
supports:
  - {boundary: lower.zmin, displacement: {x: 0, y: 0, z: 0}}
  - {name: guide, boundary: upper.ymin, displacement: {y: 0}}
)";

// A deck on its way to its load steps.
class Analysis {
  Quiet quiet_;

 public:
  explicit Analysis(const std::string& text) : document_(text, "deck.yaml", {}), deck_(model::read_deck(document_, ""))
  {
    document_.check();
    resolved_ = model::resolve(deck_, document_, partition::decompose(deck_.mesh, deck_.decomposition, 3, quiet_.context),
                               quiet_.context);
    model_.emplace(deck_, resolved_.contacts, resolved_.decomposition, resolved_.temperatures);
    states_ = model::load_states(deck_, resolved_.contacts);
    const auto copies = model_->congruent();
    assembly_.emplace(*model_, copies, quiet_.context);
    approach_.algorithm = deck_.solver.programme.algorithm;
    auto rows = make_rows(*model_, states_.front(), {}, quiet_.context);
    first_.emplace(make_dual_problem(*assembly_, std::move(rows), approach_, quiet_.context));
    solver_.emplace(*assembly_, *first_, approach_, quiet_.context);
  }

  // The states of all steps and what they come to, at their time and when all are solved.
  void solve_all()
  {
    for (const auto& acts : states_) {
      auto problem = states.empty() ? *first_ : solver_->problem_after(states.back(), acts);
      states.push_back(solver_->solve(std::move(problem), [](int, double, const qp::Progress&) {}));
      results.push_back(evaluate(*assembly_, states.back(), {}, quiet_.context));
    }
    for (const auto& solved : states) again.push_back(evaluate(*assembly_, solved, {}, quiet_.context));
  }
  // The state `i` once more, from the end of the one before it.
  StepState solve_again(std::size_t i)
  {
    return solver_->solve(solver_->problem_after(states[i - 1], states_[i]), [](int, double, const qp::Progress&) {});
  }
  const model::Deck& deck() const { return deck_; }

  const Communicator& comm = quiet_.comm;
  std::vector<StepState> states;
  std::vector<post::Results> results, again;

 private:
  deck::Document document_;
  model::Deck deck_;
  model::Resolution resolved_;
  std::optional<model::Model> model_;
  std::vector<model::LoadState> states_;
  std::optional<Assembly> assembly_;
  Approach approach_;
  std::optional<StepProblem> first_;
  std::optional<LoadStepSolver> solver_;
};

void expect_near(const std::array<double, 3>& found, const Point& exact)
{
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[static_cast<std::size_t>(c)], exact[c], 1e-7) << c;
}

// Pressed alone, without friction: uniform stress, what presses comes out below.
TEST(LoadSteps, APressedColumn)
{
  Analysis run(blocks + supports + "contacts: [{secondary: upper.zmin, primary: lower.zmax}]\n" +
               "steps: [{name: rest, scale: {push: 0}}]\n");
  // Nothing keeps the upper block from sliding along x, but nothing moves it either.
  run.solve_all();
  const auto& r = run.results.at(0);
  EXPECT_EQ(r.verdict.status, ExitStatus::solved) << r.verdict.reason;
  EXPECT_NEAR(r.fields.max_displacement, pressure / young * height, 1e-9);
  EXPECT_NEAR(r.fields.stress.largest_von_mises.value, pressure, 1e-7);
  EXPECT_NEAR(r.fields.stress.strain_energy, 0.5 * pressure * pressure / young * height * width * width, 1e-9);
  expect_near(r.forces.reactions.at(0).force, {0, 0, pressure});
  expect_near(r.forces.reactions.at(1).force, {0, 0, 0});
  const Point contact = r.contact.resultants.at(0).force;
  EXPECT_NEAR(contact[2], pressure, 1e-7);
  EXPECT_NEAR(r.contact.resultants[0].area, width * width, 1e-9);
  EXPECT_LT(r.contact.penetration, 1e-9);
  EXPECT_LT(r.forces.balance.difference, 1e-9);
  EXPECT_NEAR(r.forces.balance.applied[2], -pressure, 1e-12);
  EXPECT_NEAR(r.forces.balance.largest, pressure, 1e-7);
}

// Coulomb 0.5 carries the push; with half the pressure it could not carry more. What a state was stays what it was.
TEST(LoadSteps, StatesAreValuesThatTheNextStartsFrom)
{
  Analysis run(blocks + supports +
               "contacts: [{name: joint, secondary: upper.zmin, primary: lower.zmax, friction: {coulomb: 0.5}}]\n" +
               "steps: [{name: press, scale: {push: 0}}, {name: push, scale: {push: 1}}, {name: back, scale: {push: 0}}, {name: "
               "loose, off: [guide]}]\n");
  const auto before = model::write_deck(run.deck());
  run.solve_all();
  ASSERT_EQ(run.results.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &once = run.results[i], &twice = run.again[i];  // neither evaluating it nor solving others changes a state
    EXPECT_EQ(once.verdict.status, ExitStatus::solved) << i << once.verdict.reason;
    EXPECT_EQ(once.fields.max_displacement, twice.fields.max_displacement);
    EXPECT_EQ(once.fields.stress.strain_energy, twice.fields.stress.strain_energy);
    EXPECT_EQ(once.forces.reactions, twice.forces.reactions);
    EXPECT_EQ(once.forces.balance.applied, twice.forces.balance.applied);
    EXPECT_EQ(once.forces.balance.difference, twice.forces.balance.difference);
    EXPECT_EQ(once.accuracy.residuals.equilibrium, twice.accuracy.residuals.equilibrium);
    EXPECT_EQ(once.accuracy.residuals.supports, twice.accuracy.residuals.supports);
    EXPECT_EQ(once.contact.resultants[0].force, twice.contact.resultants[0].force);
    EXPECT_LT(once.forces.balance.difference, 1e-8) << i;
    EXPECT_NEAR(once.contact.resultants[0].force[2], pressure, 1e-6) << i;
  }
  expect_near(run.results[1].forces.reactions[0].force, {-0.5, 0, pressure});
  EXPECT_NEAR(run.results[2].contact.resultants[0].force[0], 0, 1e-6);

  const auto rows = [&](std::size_t i) {
    return run.comm.sum(static_cast<long long>(run.states[i].rows->constraints.prescribed.size()));
  };
  EXPECT_EQ(rows(0), rows(2));
  EXPECT_LT(rows(3), rows(2));  // the guide lets go: other rows, while those of the states before are as they were
  EXPECT_TRUE(run.states[0].rows->constraints.contacts.slipped.empty());
  const auto system = [&](std::size_t i) { return &run.states[i].problem.system(); };
  EXPECT_EQ(system(0), system(1));
  EXPECT_EQ(system(0), system(2));
  EXPECT_NE(system(0), system(3));
  EXPECT_EQ(model::write_deck(run.deck()), before);
}

// A state may have several after it, on its own system and on another one, in any order.
TEST(LoadSteps, GoOnFromAnyState)
{
  for (const std::string last : {"scale: {push: 0.5}", "off: [guide]"}) {
    Analysis run(blocks + supports + "contacts: [{secondary: upper.zmin, primary: lower.zmax, friction: {coulomb: 0.5}}]\n" +
                 "steps: [{name: press, scale: {push: 0}}, {name: push, scale: {push: 1}}, {name: last, " + last + "}]\n");
    run.solve_all();
    for (const std::size_t i : {1U, 2U, 1U}) {
      const auto again = run.solve_again(i);
      double apart = 0, size = 0;
      for (std::size_t s = 0; s < again.displacement.size(); ++s) {
        apart += (run.states[i].displacement[s] - again.displacement[s]).squaredNorm();
        size += again.displacement[s].squaredNorm();
      }
      EXPECT_LT(std::sqrt(run.comm.sum(apart)), 1e-7 * std::sqrt(run.comm.sum(size))) << last << ", state " << i;
    }
  }
}

// From the slip of one state friction goes on in the next, with all that it is off by.
TEST(LoadSteps, ErrorsOfSlipAddUp)
{
  Analysis run(blocks + supports + "contacts: [{secondary: upper.zmin, primary: lower.zmax, friction: {coulomb: 0.5}}]\n" +
               "steps: [{name: press, scale: {push: 0}}, {name: push}, {name: back, scale: {push: -1}}]\n");
  run.solve_all();
  double sum = 0;
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    EXPECT_EQ(run.states[i].before.slip_error, sum) << i;
    const auto& r = run.results[i];
    EXPECT_GE(r.accuracy.algebraic_error * std::sqrt(r.accuracy.mesh_error.squared_norm),
              (sum + run.states[i].solved.solution.error) * (1 - 1e-9))
        << i;
    sum += run.states[i].solved.solution.error;
  }
  EXPECT_GT(sum, 0);
}

// More than friction can carry.
TEST(LoadSteps, NoEquilibriumBeyondFriction)
{
  Analysis run(blocks + supports + "contacts: [{secondary: upper.zmin, primary: lower.zmax, friction: {coulomb: 0.2}}]\n");
  try {
    run.solve_all();
    FAIL() << "0.5 of push on 0.2 * 2 of friction";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::no_equilibrium) << error.what();
    EXPECT_NE(std::string(error.what()).find("body \"upper\""), std::string::npos) << error.what();
  }
}

TEST(Checks, ABodyThatNothingTouchesIsNamed)
{
  const Quiet quiet;
  const auto& [comm, timers, log, context] = quiet;
  deck::Document document(blocks + supports, "deck.yaml", {});
  const auto deck = model::read_deck(document, "");
  const auto resolved = model::resolve(deck, document, partition::decompose(deck.mesh, deck.decomposition, 3, context), context);
  const model::Model model(deck, resolved.contacts, resolved.decomposition, resolved.temperatures);
  auto rows = make_rows(model, model::load_states(deck, resolved.contacts).front(), {}, context);
  Warnings warnings;
  EXPECT_NO_THROW(check_unconstrained_bodies(model, rows, context, warnings));  // the guide holds it
  EXPECT_TRUE(warnings.all().empty());
  EXPECT_TRUE(check_model(model, rows, comm).empty());
}

}  // namespace
}  // namespace mortise::analysis
