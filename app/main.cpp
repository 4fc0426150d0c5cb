// mortise DECK: multibody contact of linear elasticity by Total FETI.
//
//     deck -> mesh -> bodies -> subdomains -> constraint rows -> dual problem -> QP (inside a friction loop)
//          -> multipliers -> displacements -> fields -> files
//
// Sample runs:  mortise inputs/hertz_sphere/hertz_sphere.yaml
//               mpirun -n 2 mortise inputs/cantilever_3d/cantilever_3d.yaml --set solver.tolerance=1e-6
#include "analysis/approach.hpp"
#include "analysis/checks.hpp"
#include "analysis/load_step_solver.hpp"
#include "analysis/memory.hpp"
#include "analysis/probes.hpp"
#include "analysis/restart.hpp"
#include "deck_file.hpp"
#include "load_steps.hpp"
#include "model/resolution.hpp"
#include "partition/decompose.hpp"
#include "partition/skins.hpp"
#include "partition/whole_bodies.hpp"
#include "process.hpp"
#include "report.hpp"

namespace {

using namespace mortise;

// From constraint rows to files, for all load steps.
analysis::Outcome solve_load_steps(const model::Model& model, const post::Probes& probes, const analysis::Approach& approach,
                                   const analysis::Restart& restart, Report& report, const Context& context)
{
  const auto states = model::load_states(model.deck(), model.contacts());
  auto rows = analysis::make_rows(model, states.front(), {}, context);
  report.rows(model, rows, probes, approach);
  const auto copies = model.congruent();
  const auto memory = analysis::foresee_memory(model, copies, report.only_checks(), context.comm);
  report.memory(model, rows, memory);
  analysis::require(memory, model);
  if (report.only_checks()) return {ExitStatus::solved};

  const analysis::Assembly assembly(model, copies, context);
  report.assembly(assembly, copies);
  const auto patient = analysis::with_patience(approach, assembly, rows.constraints, context.comm);
  analysis::LoadStepSolver solver(assembly, std::move(rows), patient, context);
  Report::LoadSteps steps(report, assembly, states.size(), patient);
  std::optional<analysis::StepState> state;
  for (const auto& acts : states) {
    steps.begin(acts);
    try {
      const auto* before = restart.find(approach, acts.time);
      state =
          before ? solver.take_up(acts, std::move(state), *before) : solver.solve(acts, std::move(state), steps.observer(acts));
      if (steps.gave_up(solver, *state)) return {.status = {}, .next = patient.next, .spent = solver.applications()};
      auto results = analysis::evaluate(assembly, solver, *state, probes, context);
      steps.write(solver, *state, probes, std::move(results));
      if (acts.time < states.back().time) restart.keep(steps.state(), approach, solver, *state);
    } catch (...) {
      return steps.failed(solver);
    }
    if (!steps.goes_on()) break;
  }
  const auto status = steps.end();
  if (status == ExitStatus::solved) restart.remove();
  return {status};
}

ExitStatus solve(const CommandLine& command_line, const Context& context)
{
  deck::Document document(read_text(command_line.deck, context.comm), command_line.deck, command_line.settings);
  const auto deck = read_deck(document, command_line, context.comm);
  const analysis::Restart restart(deck, command_line.resume, context.comm);
  Report report(deck, document, command_line, context);

  auto decomposition = partition::decompose(deck.mesh, deck.decomposition, deck.dimension(), context);
  if (deck.solver.programme.algorithm == "direct") decomposition = partition::whole_bodies(decomposition, context.comm);
  const auto on_surface = model::bodies_of_boundary_elements(deck, decomposition.catalogue);
  decomposition = partition::skins(std::move(decomposition), on_surface, deck.output.asks_inside(), context.comm);
  report.mesh(decomposition);
  const auto resolved = model::resolve(deck, document, std::move(decomposition), context);
  report.resolution(resolved);

  const auto attempt = [&](const partition::Decomposition& bodies, const analysis::Approach& approach) {
    const model::Model model(deck, resolved.contacts, bodies, resolved.temperatures);
    model.require_fit(document, context.comm);
    const auto probes = analysis::find_probes(model, document, context.comm);
    return solve_load_steps(model, probes, approach, restart, report, context);
  };
  try {
    return analysis::try_approaches(deck, resolved.decomposition, attempt, context, restart.approach());
  } catch (const Error& error) {
    report.tell_interrupted(error);
    throw;
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return run_process(argc, argv, solve);
}
