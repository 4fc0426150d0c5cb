#include "output/summary.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "base/traffic_counted.hpp"
#include "output/probe_files.hpp"

namespace mortise::output {

namespace {

// What it leaves open; the summary's contacts stand there already.
void add_unresolved_contact(const feti::DualSolution& solved, const model::Contacts& contacts, io::StateSummary& summary)
{
  const auto band = [](const feti::Undecided::Band& b) { return io::StateSummary::Contact::Band{b.points, b.cells}; };
  for (const auto& u : solved.undecided)
    summary.contacts[static_cast<std::size_t>(u.contact)].undecided = {band(u.rim), band(u.edge_of_stick)};
  for (const auto& s : solved.stuck)
    summary.stuck.push_back({contacts[static_cast<std::size_t>(s.contact)].name,
                             s.points,
                             s.states,
                             {s.place[0], s.place[1], s.place[2]},
                             s.turns,
                             s.of});
}

void add_work(const feti::DualSolution& solved, io::StateSummary& summary)
{
  summary.friction_steps = solved.steps;
  summary.outer_iterations = solved.outer_iterations;
  summary.hessian_multiplications = solved.applications;
}

// Residuals, errors, and the figures of the whole model.
void add_figures(const post::Fields& fields, const post::Accuracy& accuracy, const mesh::Catalogue& catalogue,
                 io::StateSummary& summary)
{
  const auto& r = accuracy.residuals;
  summary.residuals = {r.projected_gradient, r.equality, r.equilibrium, r.penetration,
                       r.complementarity,    r.supports, r.interfaces};
  summary.error_estimate.discretization = accuracy.mesh_error.relative;
  summary.error_estimate.algebraic = accuracy.algebraic_error;
  summary.strain_energy = fields.stress.strain_energy;
  summary.max_displacement = fields.max_displacement;
  const auto& largest = fields.stress.largest_von_mises;
  summary.max_von_mises = largest.value;
  summary.max_von_mises_place.coordinates = {largest.at[0], largest.at[1], largest.at[2]};
  if (largest.body >= 0) summary.max_von_mises_place.body = catalogue.bodies[static_cast<std::size_t>(largest.body)].name;
}

// About the point that the deck names.
std::array<double, 3> moment_of(const model::Deck& deck, const post::Reaction& reaction)
{
  const auto& p = deck.output.moments_about;
  const auto &f = reaction.force, &m = reaction.moment;
  return {m[0] - p[1] * f[2] + p[2] * f[1], m[1] - p[2] * f[0] + p[0] * f[2], m[2] - p[0] * f[1] + p[1] * f[0]};
}

void add_reactions(const model::Deck& deck, std::span<const post::Reaction> reactions, io::StateSummary& summary)
{
  summary.moments_about = deck.output.moments_about;
  for (std::size_t s = 0; s < reactions.size(); ++s) {
    const auto& support = deck.supports[s];
    if (!support.coupling.empty()) continue;
    summary.reactions.push_back({support.boundary, reactions[s].force, {}, support.name});
    if (deck.axisymmetric())
      summary.reactions.back().force[0] = 0;  // all round it cancels
    else
      summary.reactions.back().moment = moment_of(deck, reactions[s]);
  }
}

void add_couplings(const model::Deck& deck, std::span<const post::CouplingState> states, io::StateSummary& summary)
{
  const auto head = [](const std::array<double, 6>& x) { return std::array{x[0], x[1], x[2]}; };
  const auto tail = [](const std::array<double, 6>& x) { return std::array{x[3], x[4], x[5]}; };
  auto state = states.begin();
  for (const auto& [name, options] : deck.couplings) {
    const auto& [motion, action, reaction] = *state++;
    const bool prescribed =
        std::any_of(deck.supports.begin(), deck.supports.end(), [&](const auto& s) { return s.coupling == name; });
    summary.couplings.push_back({name, options.boundary, head(motion), tail(motion), head(action), tail(action), head(reaction),
                                 tail(reaction), prescribed});
  }
}

void add_springs(const model::Deck& deck, std::span<const post::SpringState> states, io::StateSummary& summary)
{
  auto state = states.begin();
  for (const auto& [name, options] : deck.springs) {
    summary.springs.push_back({name, state->force, state->elongation});
    ++state;
  }
}

void add_contacts(const model::Contacts& contacts, const analysis::StepState& state, const post::ContactResults& found,
                  std::span<const double> shortenings, const Communicator& comm, io::StateSummary& summary)
{
  const auto largest = [&](const std::vector<double>& pressure) {
    return comm.max(pressure.empty() ? 0.0 : *std::max_element(pressure.begin(), pressure.end()));
  };
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& r = found.resultants[c];
    const auto& surface = found.surfaces[c];
    // On the side that the deck calls secondary.
    const Point force = contacts[c].exchanged ? Point(Point::Zero() - r.force) : r.force;
    summary.contacts.push_back({contacts[c].name,
                                {force[0], force[1], force[2]},
                                std::max(largest(surface.pressure), 0.0),
                                r.area,
                                r.open,
                                r.stick,
                                r.slip,
                                largest(surface.recovered_pressure),
                                found.tensions[c]});
    const auto& gap = state.rows->initial_gaps[c];
    summary.contacts.back().exchanged = contacts[c].exchanged;
    summary.contacts.back().initial_gap = {gap.smallest, gap.largest_overlap(), gap.touching_area};
  }
  const auto& pretension_sections = state.rows->constraints.pretension_sections;
  for (std::size_t i = 0; i < pretension_sections.size(); ++i) {
    const auto contact = static_cast<std::size_t>(pretension_sections[i].preload.contact);
    summary.contacts[contact].preload = {pretension_sections[i].normal.dot(found.resultants[contact].force), shortenings[i]};
  }
}

io::Summary::Spread over_ranks(const Traffic& mine, const Communicator& comm)
{
  io::Summary::Spread result;
  const auto spread = [&](long long x, double& largest, double& mean) {
    largest = static_cast<double>(comm.max(x));
    mean = static_cast<double>(comm.sum(x)) / comm.size();
  };
  spread(mine.messages, result.largest.messages, result.mean.messages);
  spread(mine.bytes, result.largest.bytes, result.mean.bytes);
  spread(mine.collectives, result.largest.collectives, result.mean.collectives);
  spread(mine.collective_bytes, result.largest.collective_bytes, result.mean.collective_bytes);
  return result;
}

}  // namespace

io::Summary sizes_of(const feti::DualSystem& system, const Communicator& comm)
{
  const auto& decomposition = system.decomposition();
  io::Summary result;
  for (const auto& subdomain : decomposition.subdomains)
    result.primal_unknowns += static_cast<Global>(subdomain.mesh.node_count()) * system.dimension();
  result.primal_unknowns = comm.sum(result.primal_unknowns);
  result.dual_unknowns = system.dual_unknowns();
  result.subdomains = decomposition.subdomain_count();
  result.clusters = decomposition.clustered() ? decomposition.cluster_count() : 0;
  result.kernel_dimension = system.kernel_dimension();
  for (const auto& subdomain : system.clusters().subdomains()) result.single_precision += subdomain->rounding() > 0 ? 1 : 0;
  result.single_precision = comm.sum(result.single_precision);
  return result;
}

io::Summary sizes_told(const std::string& json)
{
  const auto told = nlohmann::json::parse(json, nullptr, false);
  io::Summary result;
  const auto take = [&](const char* key, auto& size) {
    if (const auto found = told.find(key); found != told.end() && found->is_number_integer()) found->get_to(size);
  };
  if (!told.is_object()) return result;
  take("primal_unknowns", result.primal_unknowns);
  take("dual_unknowns", result.dual_unknowns);
  take("subdomains", result.subdomains);
  take("clusters", result.clusters);
  take("kernel_dimension", result.kernel_dimension);
  take("single_precision", result.single_precision);
  return result;
}

void copy_sizes(const io::Summary& from, io::Summary& to)
{
  to.primal_unknowns = from.primal_unknowns;
  to.dual_unknowns = from.dual_unknowns;
  to.subdomains = from.subdomains;
  to.clusters = from.clusters;
  to.kernel_dimension = from.kernel_dimension;
  to.single_precision = from.single_precision;
}

io::Summary summarise(const model::Model& model, const EvaluatedState& found, const Communicator& comm)
{
  const auto& results = found.results;
  const auto& catalogue = found.decomposition.catalogue;
  io::Summary summary = sizes_of(found.state.problem.system(), comm);
  summary.title = model.deck().title;
  summary.bodies = static_cast<Global>(catalogue.bodies.size());
  for (const auto& body : catalogue.bodies) summary.body_names.push_back(body.name);
  summary.ranks = comm.size();
  summary.converged = results.verdict.solved();
  summary.exit_status = static_cast<int>(results.verdict.status);
  add_work(found.state.solved, summary);
  add_figures(results.fields, results.accuracy, catalogue, summary);
  add_reactions(model.deck(), results.forces.reactions, summary);
  summary.probes = probe_summaries(model.deck(), catalogue, found.probes, results.fields, comm);
  add_couplings(model.deck(), results.forces.couplings, summary);
  add_springs(model.deck(), results.forces.springs, summary);
  add_contacts(model.contacts(), found.state, results.contact, results.forces.shortenings, comm, summary);
  add_unresolved_contact(found.state.solved, model.contacts(), summary);
  return summary;
}

void accumulate_steps(const model::LoadState& acts, const io::Summary& before, io::Summary& summary)
{
  summary.steps = before.steps;
  if (acts.step.empty()) return;
  io::Summary::Step step;
  static_cast<io::StateSummary&>(step) = summary;
  step.name = acts.step;
  step.time = acts.time;
  summary.steps.push_back(std::move(step));
  summary.friction_steps += before.friction_steps;
  summary.outer_iterations += before.outer_iterations;
  summary.hessian_multiplications += before.hessian_multiplications;
}

void note_communication(const Timers& timers, const Traffic& total, const Communicator& comm, io::Summary& summary)
{
  if (!traffic_is_counted()) return;
  const Traffic solve = timers.traffic("solve");
  summary.communication["total"] = over_ranks(total, comm);
  summary.communication["set_up"] = over_ranks(total - solve - timers.traffic("output"), comm);
  summary.communication["solve"] = over_ranks(solve, comm);
  summary.communication["multiplication"] = over_ranks(timers.traffic("multiplication"), comm);
}

}  // namespace mortise::output
