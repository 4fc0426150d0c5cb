// Files and summary of runs of two load steps, where statics says what is to be found. The same on any ranks.
#include <gtest/gtest.h>

#include "../../io/test/scratch.hpp"
#include "analysis/probes.hpp"
#include "deck_of_blocks.hpp"
#include "model/resolution.hpp"
#include "output/field_files.hpp"
#include "output/summary.hpp"
#include "testing/quiet.hpp"

namespace mortise::output {
namespace {

// The upper block presses with 2 in step "on", with 3 in step "more".
const std::string pressed = R"(
solver: {algorithm: face_newton, tolerance: 1e-10}
supports:
  - {name: ground, boundary: lower.zmin, displacement: {x: 0, y: 0, z: 0}}
  - {name: guide, boundary: upper.zmax, displacement: {x: 0, y: 0}}
loads: [{name: press, boundary: upper.zmax, pressure: 2}]
contacts: [{name: joint, secondary: upper.zmin, primary: lower.zmax}]
steps: [{name: on}, {name: more, scale: {press: 1.5}}]
output:
  moments_about: [0, 0, 0]
  interior: {points: [[1, 0.5, 1.5]], planes: {middle: {point: [1, 0.5, 0], normal: [0, 1, 0]}}}
)";

TEST(Runs, LeaveFilesAndASummary)
{
  Quiet quiet;
  const auto& [comm, timers, log, context] = quiet;
  const io::test::Scratch folder(comm);
  deck::Document document(deck_of_blocks + pressed, "deck.yaml", {});
  const auto deck = model::read_deck(document, folder.path());
  document.check();
  const auto resolved = model::resolve(deck, document, partition::decompose(deck.mesh, deck.decomposition, 3, context), context);
  const model::Model model(deck, resolved.contacts, resolved.decomposition, resolved.temperatures);
  const auto probes = analysis::find_probes(model, document, comm);
  const auto states = model::load_states(deck, resolved.contacts);
  const analysis::Assembly assembly(model, model.congruent(), context);
  analysis::Approach approach;
  approach.algorithm = deck.solver.programme.algorithm;
  auto rows = analysis::make_rows(model, states.front(), {}, context);
  auto problem = analysis::make_dual_problem(assembly, std::move(rows), approach, context);
  analysis::LoadStepSolver solver(assembly, problem, approach, context);

  FieldFiles files(deck);
  io::Summary all;
  std::optional<analysis::StepState> state;
  for (const auto& acts : states) {
    if (state) problem = solver.problem_after(std::move(*state), acts);
    state = solver.solve(std::move(problem), [](int, double, const qp::Progress&) {});
    const auto results = analysis::evaluate(assembly, *state, probes, context);
    const EvaluatedState found{model.decomposition(), assembly.interface(), *state, probes, results};
    auto summary = summarise(model, found, comm);
    accumulate_steps(acts, all, summary);
    all = std::move(summary);
    files.write(found, true, acts.time == states.back().time, comm);
  }

  ASSERT_EQ(all.steps.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& step = all.steps[i];
    const double force = i == 0 ? 2 : 3;  // on an area of 1, about (1, 0.5)
    ASSERT_EQ(step.reactions.size(), 2U);
    const Point ground(step.reactions[0].force.data()), moment(step.reactions[0].moment->data());
    EXPECT_LT((ground - Point(0, 0, force)).norm(), 1e-6);
    EXPECT_LT((moment - Point(0.5 * force, -force, 0)).norm(), 1e-6);
    ASSERT_EQ(step.contacts.size(), 1U);
    EXPECT_EQ(step.contacts[0].name, "joint");
    EXPECT_NEAR(step.contacts[0].force[2], force, 1e-6);
    EXPECT_EQ(step.contacts[0].initial_gap->smallest, 0);
  }
  EXPECT_EQ(all.steps[1].name, "more");
  EXPECT_EQ(all.hessian_multiplications, all.steps[0].hessian_multiplications + all.steps[1].hessian_multiplications);
  EXPECT_EQ(all.body_names, (std::vector<std::string>{"lower", "upper"}));
  EXPECT_EQ(all.subdomains, 4);
  const auto names = folder.files();
  for (const char* name : {"solution.pvd", "solution.1_0.vtu", "solution.2_0.vtu", "contact.pvd", "blocks.pvd",
                           "plane.middle.pvd", "results.1.h5", "results.h5", "interior.csv"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_FALSE(names.contains("results.2.h5"));
  const auto points = io::test::content(folder / "interior.csv");
  EXPECT_TRUE(points.starts_with("step,time,x,y,z,body,ux,")) << points;
  EXPECT_NE(points.find("\non,1,1,0.5,1.5,upper,"), std::string::npos) << points;
  EXPECT_NE(points.find("\nmore,2,1,0.5,1.5,upper,"), std::string::npos) << points;
}

TEST(Sizes, OfAnEarlierRunAreReadFromItsSummary)
{
  const auto told = sizes_told(R"({"primal_unknowns": 12, "subdomains": 3, "kernel_dimension": "six"})");
  EXPECT_EQ(told.primal_unknowns, 12);
  EXPECT_EQ(told.subdomains, 3);
  EXPECT_EQ(told.kernel_dimension, 0);
  EXPECT_EQ(sizes_told("{cut").subdomains, 0);
  io::Summary other;
  copy_sizes(told, other);
  EXPECT_EQ(other.primal_unknowns, 12);
}

}  // namespace
}  // namespace mortise::output
