#include "warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "post/deformation.hpp"
#include "post/model_checks.hpp"
#include "post/strength.hpp"

namespace mortise {

namespace {

std::vector<std::string> body_names(const mesh::Catalogue& catalogue)
{
  std::vector<std::string> names;
  for (const auto& body : catalogue.bodies) names.push_back(body.name);
  return names;
}

std::vector<post::BodyMaterial> body_materials(const Deck& deck, const partition::Decomposition& decomposition,
                                               const std::vector<double>& sizes, const Communicator& comm)
{
  const auto& bodies = decomposition.catalogue.bodies;
  std::vector<double> straight(bodies.size(), 0.0);
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto type : subdomain.mesh.cells.type)
      if (mesh::first_order(type) == type) straight[static_cast<std::size_t>(subdomain.body)] = 1;
  comm.sum_in_place(straight);
  std::vector<post::BodyMaterial> result;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& options = deck.bodies.at(bodies[b].group);
    for (const auto& name : material_names(options))
      result.push_back({bodies[b].name, sizes[b], deck.materials.at(name), options.formulation, straight[b] > 0});
  }
  return result;
}

std::vector<post::AppliedStress> applied_stresses(const Deck& deck, const Model& model, const LoadState& state,
                                                  const Communicator& comm)
{
  std::vector<post::AppliedStress> result;
  const auto length = [](const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); };
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& load = deck.loads[i];
    if (load.boundary.empty() || state.load[i] == 0) continue;
    const auto facts = model.facts(load.boundary, comm);
    double stress = 0;
    if (load.pressure) stress = std::abs(*load.pressure);
    if (load.traction) stress = length(*load.traction);
    if (load.force) stress = facts.area > 0 ? length(*load.force) / facts.area : 0;
    result.push_back({load.boundary, std::abs(state.load[i]) * stress, facts.young_modulus});
  }
  return result;
}

std::vector<post::SupportLoad> support_loads(const Deck& deck, const Model& model, const Results& results,
                                             const Communicator& comm)
{
  std::vector<post::SupportLoad> result;
  for (std::size_t i = 0; i < deck.supports.size(); ++i) {
    const auto facts = model.facts(deck.supports[i].boundary, comm);
    auto force = results.summary.reactions[i].force;
    if (deck.axisymmetric()) force[0] = 0;  // what holds a ring together is no resultant
    result.push_back({deck.supports[i].boundary, force, facts.area, facts.centre, facts.young_modulus});
  }
  return result;
}

// A surface that closes where the search for contact ended may have closed farther on as well.
std::vector<Warning> short_searches(const Deck& deck, const Simulation& simulation, const Results& results,
                                    const Communicator& comm)
{
  constexpr double close = 0.7;  // of the search distance
  const auto& pairs = simulation.pairs();
  const auto& contacts = simulation.constraints().contacts;
  const auto reaches = contact::search_distances(pairs, comm);
  std::vector<post::Found> widest(pairs.size());
  for (std::size_t i = 0; i < results.points.size(); ++i)
    if (results.points[i].status != contact::Status::open)
      widest[static_cast<std::size_t>(results.points[i].contact)].take(contacts.points[i].gap, contacts.points[i].at);
  widest = post::largest_of_ranks(widest, comm);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (pairs[c].options.law == contact::Law::bonded) continue;
    const double gap = widest[c].value + pairs[c].options.interference;
    if (!(gap > close * reaches[c])) continue;
    Warning w{"short_search",
              fmt::format("contact {} closes over gaps of up to {:.3g}, close to the search distance {:.3g}",
                          deck.contacts[c].name, gap, reaches[c]),
              "set a larger search_distance and solve again"};
    w.at = widest[c].at;
    w.contact = deck.contacts[c].name;
    w.boundary = deck.contacts[c].secondary;
    w.value = gap;
    w.limit = close * reaches[c];
    result.push_back(std::move(w));
  }
  return result;
}

void append(std::vector<Warning>& all, std::vector<Warning> more)
{
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

void Warnings::add(Warning warning)
{
  for (auto& known : all_) {
    if (known.kind != warning.kind || known.body != warning.body || known.boundary != warning.boundary ||
        known.contact != warning.contact)
      continue;
    if (warning.value > known.value) known = std::move(warning);
    return;
  }
  all_.push_back(std::move(warning));
}

void Warnings::tell(Warning warning, Log& log)
{
  log.warning("{}; {}", warning.text, warning.cure);
  add(std::move(warning));
}

std::vector<Warning> check_model(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                                 const Simulation& simulation, const Communicator& comm)
{
  const auto sizes = post::body_sizes(decomposition, deck.kinematics, comm);
  const auto materials = body_materials(deck, decomposition, sizes, comm);
  auto result = idle_contacts(simulation.constraints().contacts, deck, comm);
  append(result, post::locking(materials, deck.kinematics));
  append(result, post::mixed_units(materials, applied_stresses(deck, model, simulation.state(), comm)));
  append(result, post::doubled_contacts(simulation.pairs(), comm));
  return result;
}

std::vector<Warning> check_results(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                                   const Simulation& simulation, const Results& results, const Communicator& comm)
{
  const auto sizes = post::body_sizes(decomposition, deck.kinematics, comm);
  const auto names = body_names(decomposition.catalogue);
  std::vector<double> softest(names.size(), std::numeric_limits<double>::infinity());
  for (std::size_t b = 0; b < names.size(); ++b)
    for (const auto& material : material_names(deck.bodies.at(decomposition.catalogue.bodies[b].group)))
      softest[b] = std::min(softest[b], deck.materials.at(material).young_modulus);
  const auto& contacts = simulation.constraints().contacts;
  auto result = post::large_displacements(decomposition, sizes, results.displacement, comm);
  append(result, post::inverted_cells(decomposition, results.displacement, comm));
  append(result, post::long_slides(simulation.pairs(), contacts, results.points, decomposition, results.displacement, comm));
  append(result, post::large_pressures(results.surfaces, simulation.pairs(), softest, names, comm));
  append(result, post::strained_supports(support_loads(deck, model, results, comm), results.largest_force));
  append(result, post::coarse_mesh(results.mesh_error, names));
  append(result, post::facet_push(results.push_of_facets, results.gauges));
  append(result, short_searches(deck, simulation, results, comm));
  for (auto& warning : result) warning.step = simulation.state().step;
  return result;
}

std::vector<Warning> idle_contacts(const constraint::Contacts& contacts, const Deck& deck, const Communicator& comm)
{
  std::vector<double> points(deck.contacts.size(), 0.0);
  for (const auto& point : contacts.points) points[static_cast<std::size_t>(point.contact)] += 1;
  comm.sum_in_place(points);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < points.size(); ++c) {
    if (points[c] > 0) continue;
    Warning w{
        "idle_contact",
        fmt::format("contact {} has no point: its surfaces do not face each other within the search distance, or share less than "
                    "a hundredth of a cell, and nothing keeps them apart",
                    deck.contacts[c].name),
        "look at the names, set a larger search_distance, or refine the secondary side"};
    w.contact = deck.contacts[c].name;
    w.boundary = deck.contacts[c].secondary;
    w.limit = 1;
    result.push_back(std::move(w));
  }
  return result;
}

void print(const Warnings& warnings, Log& log)
{
  for (const auto& w : warnings.all())
    log.warning("{}{}; {}", w.step.empty() ? "" : fmt::format("step {}: ", w.step), w.text, w.cure);
}

}  // namespace mortise
