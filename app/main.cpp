// mortise DECK: multibody contact of linear elasticity by Total FETI.
//
//     deck -> mesh -> bodies -> subdomains -> constraint rows -> dual problem -> QP (inside a friction loop)
//          -> multipliers -> displacements -> fields -> files
//
// Sample runs:  mortise inputs/hertz_sphere/hertz_sphere.yaml
//               mpirun -n 2 mortise inputs/cantilever_3d/cantilever_3d.yaml --set solver.tolerance=1e-6
#include "analysis/load_step_solver.hpp"
#include "analysis/probes.hpp"
#include "deck_file.hpp"
#include "load_steps.hpp"
#include "model/subdomains.hpp"
#include "process.hpp"
#include "report.hpp"

namespace {

using namespace mortise;

// On one decomposition, by one approach: from constraint rows to files, for all load steps.
analysis::Outcome solve_load_steps(const model::Model& model, const post::Probes& probes, const analysis::Approach& asked,
                                   const analysis::Restart& restart, Report& report, const Context& context)
{
  const auto states = model::load_states(model.deck(), model.contacts());
  auto rows = analysis::make_rows(model, states.front(), {}, context);  // B u = c, B u <= c
  const auto copies = model.congruent();
  if (!report.may_solve(model, rows, copies, probes, asked)) return {ExitStatus::solved};  // --check

  const analysis::Assembly assembly(model, copies, context);  // K of every subdomain, and its factors
  report.assembly(assembly, copies);
  const auto approach = analysis::with_patience(asked, assembly, rows.constraints, context.comm);
  // min 1/2 l'F l - l'd, G l = e, l in Omega
  auto problem = analysis::make_dual_problem(assembly, std::move(rows), approach, context);
  analysis::LoadStepSolver solver(assembly, problem, approach, context);

  Report::LoadSteps steps(report, assembly, states.size(), approach, restart);
  std::optional<analysis::StepState> state;
  std::optional<Report::LoadSteps::Written> written;
  for (const auto& acts : states) {
    const auto begun = steps.begin(acts, written);
    try {
      if (state) problem = solver.problem_after(std::move(*state), acts);
      const auto* record = restart.find(approach, acts.time);  // of a run that this one resumes
      state = record ? solver.take_up(std::move(problem), *record) : solver.solve(std::move(problem), steps.observer(begun));
      if (steps.gave_up(*state)) return solver.given_up(*state);
      if (&acts == &states.back()) solver.let_go();
      const auto results = analysis::evaluate(assembly, *state, probes, context);
      written = steps.write(begun, *state, probes, results, written);
      steps.keep(*written, *state);
    } catch (...) {
      return steps.failed(begun, solver, written);
    }
    if (!steps.goes_on(*written)) break;
  }
  return {steps.end(*written)};
}

ExitStatus solve(const CommandLine& command_line, const Context& context)
{
  deck::Document document(read_text(command_line.deck, context.comm), command_line.deck, command_line.settings);
  const auto deck = read_deck(document, command_line, context.comm);
  const analysis::Restart restart(deck, command_line.resume, context.comm);
  Report report(deck, document, command_line, context);

  auto subdomains = model::make_subdomains(deck, context);  // mesh, bodies, subdomains
  report.mesh(subdomains);
  const auto resolved = model::resolve(deck, document, std::move(subdomains), context);
  report.resolution(resolved);

  const auto attempt = [&](const partition::Decomposition& decomposition, const analysis::Approach& approach) {
    const model::Model model(deck, resolved.contacts, decomposition, resolved.temperatures);
    model.require_fit(document, context.comm);
    const auto probes = analysis::find_probes(model, document, context.comm);
    return solve_load_steps(model, probes, approach, restart, report, context);
  };
  return report.watch(
      [&] { return analysis::try_approaches(deck, resolved.decomposition, attempt, context, restart.approach()); });
}

}  // namespace

int main(int argc, char** argv)
{
  return run_process(argc, argv, solve);
}
