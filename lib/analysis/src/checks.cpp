#include "analysis/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "model/crossed_bodies.hpp"
#include "model/patterns.hpp"
#include "model_warnings.hpp"
#include "post/contact_motion.hpp"
#include "post/deformation.hpp"
#include "post/model_checks.hpp"
#include "post/strength.hpp"

namespace mortise::analysis {

namespace {

std::vector<std::string> body_names(const mesh::Catalogue& catalogue)
{
  std::vector<std::string> names;
  for (const auto& body : catalogue.bodies) names.push_back(body.name);
  return names;
}

// Whether some load uses the density of a body.
bool weighs(const model::Deck& deck, const model::LoadState& state, const mesh::Body& body)
{
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& load = deck.loads[i];
    if ((load.acceleration || load.centrifugal) && state.load[i] != 0 && model::matches_name(body, load.body)) return true;
  }
  return false;
}

std::vector<post::BodyMaterial> body_materials(const model::Model& model, const model::LoadState& state,
                                               const std::vector<double>& sizes, const Communicator& comm)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  const auto& bodies = decomposition.catalogue.bodies;
  std::vector<double> straight(bodies.size(), 0.0);
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto type : subdomain.mesh.cells.type)
      if (!subdomain.skin && mesh::first_order(type) == type) straight[static_cast<std::size_t>(subdomain.body)] = 1;
  comm.sum_in_place(straight);
  std::vector<post::BodyMaterial> result;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& options = model::body_entry(deck, bodies[b].group)->second;
    for (const auto& name : model::material_names(options))
      result.push_back({bodies[b].name, sizes[b], deck.materials.at(name), options.formulation, straight[b] > 0,
                        weighs(deck, state, bodies[b])});
  }
  return result;
}

std::vector<post::AppliedStress> applied_stresses(const model::Model& model, const model::LoadState& state,
                                                  const Communicator& comm)
{
  const auto& deck = model.deck();
  std::vector<post::AppliedStress> result;
  const auto length = [](const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); };
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& load = deck.loads[i];
    if (load.boundary.empty() || state.load[i] == 0) continue;
    const auto facts = model.facts(load.boundary, comm);
    double stress = 0;
    if (load.pressure) stress = std::abs(load.pressure->constant());  // 0 of a formula
    if (load.traction)
      stress = length({(*load.traction)[0].constant(), (*load.traction)[1].constant(), (*load.traction)[2].constant()});
    if (load.force) stress = facts.area > 0 ? length(*load.force) / facts.area : 0;
    result.push_back({load.boundary, std::abs(state.load[i]) * stress, facts.young_modulus});
  }
  return result;
}

// Each load at its largest.
model::LoadState at_most(const model::Model& model)
{
  auto states = model::load_states(model.deck(), model.contacts());
  model::LoadState result = states.front();
  for (const auto& state : states)
    for (std::size_t i = 0; i < state.load.size(); ++i)
      result.load[i] = std::max(std::abs(result.load[i]), std::abs(state.load[i]));
  return result;
}

std::vector<post::SupportLoad> support_loads(const model::Model& model, std::span<const post::Reaction> reactions,
                                             const Communicator& comm)
{
  const auto& deck = model.deck();
  std::vector<post::SupportLoad> result;
  for (std::size_t i = 0; i < deck.supports.size(); ++i) {
    if (deck.supports[i].boundary.empty()) continue;
    const auto facts = model.facts(deck.supports[i].boundary, comm);
    auto force = reactions[i].force;
    if (deck.axisymmetric()) force[0] = 0;  // what holds a ring together is no resultant
    result.push_back({deck.supports[i].boundary, force, facts.area, facts.centre, facts.mean_modulus});
  }
  return result;
}

std::vector<post::PointForce> point_forces(const model::Model& model, const model::LoadState& state, const post::Forces& forces)
{
  const auto& deck = model.deck();
  const auto length = [](const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); };
  std::vector<post::PointForce> result;
  for (std::size_t i = 0; i < deck.loads.size(); ++i)
    if (!deck.loads[i].points.empty())
      result.push_back({"load " + deck.loads[i].name, std::abs(state.load[i]) * length(*deck.loads[i].force)});
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    if (!deck.supports[i].points.empty())
      result.push_back({"support " + deck.supports[i].name, length(forces.reactions[i].force)});
  auto spring = deck.springs.begin();
  for (const auto& found : forces.springs) result.push_back({"spring " + (spring++)->first, std::abs(found.force)});
  return result;
}

// A surface that closes where the search for contact ended may have closed farther on as well.
std::vector<Warning> short_searches(const Rows& rows, std::span<const contact::ContactNodeState> states, const Communicator& comm)
{
  constexpr double close = 0.7;  // of the search distance
  const auto& pairs = rows.pairs;
  const auto& contacts = rows.constraints.contacts;
  const auto reaches = contact::search_distances(pairs, comm);
  std::vector<post::Found> widest(pairs.size());
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].status != contact::Status::open)
      widest[static_cast<std::size_t>(states[i].contact)].take(contacts.nodes[i].gap, contacts.nodes[i].at);
  widest = post::largest_of_ranks(widest, comm);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (pairs[c].options.law == contact::Law::bonded) continue;
    const double gap = widest[c].value + pairs[c].options.interference;
    if (!(gap > close * reaches[c])) continue;
    Warning w{"short_search",
              fmt::format("contact {} closes over gaps of up to {:.3g}, close to the search distance {:.3g}",
                          pairs[c].options.name, gap, reaches[c]),
              "set a larger search_distance and solve again"};
    w.at = widest[c].at;
    w.contact = pairs[c].options.name;
    w.boundary = pairs[c].options.secondary;
    w.value = gap;
    w.limit = close * reaches[c];
    result.push_back(std::move(w));
  }
  return result;
}

// Of one body with itself, or of two: the deepest one, and how many others there are.
Warning crossing_of(const model::CrossedBodies& worst, std::size_t count, const std::vector<std::string>& names)
{
  const auto& name = names[static_cast<std::size_t>(worst.bodies.first)];
  const std::string place = fmt::format("{:.3g} at ({:.5g}, {:.5g}, {:.5g}): no contact there was found or named", worst.depth,
                                        worst.at[0], worst.at[1], worst.at[2]);
  const auto others = [&](const char* one, const char* more) {
    return count > 2 ? fmt::format("; {} more {} do", count - 1, more) : count == 2 ? fmt::format("; another {} does", one) : "";
  };
  Warning w;
  if (worst.bodies.first == worst.bodies.second)
    w = {"self_crossing",
         fmt::format("faces of body \"{}\" pass through each other by {}{}", name, place, others("body", "bodies")),
         "name the two faces that meet as the sides of a contact"};
  else
    w = {"crossed_bodies",
         fmt::format("bodies \"{}\" and \"{}\" stand in each other by {}{}", name,
                     names[static_cast<std::size_t>(worst.bodies.second)], place, others("pair", "pairs")),
         "name the faces that meet in a contact, or give the entry `auto` a larger search_distance"};
  w.at = worst.at;
  w.body = name;
  w.value = worst.depth;
  return w;
}

// `contacts: auto` looks as far as it is told, and not at what moves farther; a named contact looks at its faces.
std::vector<Warning> crossings(const model::Model& model, const std::vector<Eigen::VectorXd>& displacement,
                               const std::vector<std::string>& names, const Communicator& comm)
{
  auto crossed = model::crossed_bodies(model, displacement, comm);
  const auto selves =
      std::stable_partition(crossed.begin(), crossed.end(), [](const auto& c) { return c.bodies.first != c.bodies.second; });
  std::vector<Warning> result;
  if (selves != crossed.begin())
    result.push_back(crossing_of(crossed.front(), static_cast<std::size_t>(selves - crossed.begin()), names));
  if (selves != crossed.end()) result.push_back(crossing_of(*selves, static_cast<std::size_t>(crossed.end() - selves), names));
  return result;
}

void append(std::vector<Warning>& all, std::vector<Warning> more)
{
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

std::vector<Warning> check_model(const model::Model& model, const Rows& rows, const Communicator& comm)
{
  const auto kinematics = model.deck().kinematics;
  const auto materials = body_materials(model, rows.acts, post::body_sizes(model.decomposition(), kinematics, comm), comm);
  auto result = idle_contacts(rows, comm);
  append(result, post::locking(materials, kinematics));
  append(result, post::mixed_units(materials, applied_stresses(model, rows.acts, comm)));
  append(result, post::doubled_contacts(rows.pairs, comm));
  append(result, coarser_than_asked(model, comm));
  append(result, unconnected_faces(model, comm));
  append(result, uncovered_temperatures(model, comm));
  append(result, post::folded_cells(model.decomposition(), comm));
  return result;
}

std::vector<Warning> check_results(const model::Model& model, const StepState& state, const post::Results& results,
                                   const Communicator& comm)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  const auto sizes = post::body_sizes(decomposition, deck.kinematics, comm);
  const auto names = body_names(decomposition.catalogue);
  std::vector<double> softest(names.size(), std::numeric_limits<double>::infinity());
  for (std::size_t b = 0; b < names.size(); ++b)
    for (const auto& material : model::material_names(model::body_entry(deck, decomposition.catalogue.bodies[b].group)->second))
      softest[b] = std::min(softest[b], deck.materials.at(material).modulus());
  const auto& pairs = state.rows->pairs;
  const auto& [fields, contact, forces, accuracy, neglected, verdict] = results;
  auto result = post::large_displacements(decomposition, sizes, state.displacement, comm);
  append(result, post::inverted_cells(decomposition, state.displacement, comm));
  append(result, post::slides_and_rolls(pairs, state.rows->constraints.contacts, contact.states, decomposition, deck.kinematics,
                                        state.displacement, comm));
  append(result, post::large_turns(neglected.turn, pairs, names));
  append(result, post::large_pressures(contact.surfaces, pairs, softest, names, comm));
  append(result, post::narrow_contacts(contact.surfaces, contact.states, pairs, state.before.unfelt(), comm));
  append(result, post::scattered_contacts(contact.surfaces, pairs, softest, comm));
  append(result, post::lost_moments(neglected.moments, pairs, forces.balance.acting));
  append(result,
         post::loose_fits(contact.states, pairs, *std::ranges::min_element(softest), *std::ranges::max_element(sizes), comm));
  std::vector<double> areas;
  for (const auto& resultant : contact.resultants) areas.push_back(resultant.area);
  append(result, post::tied_preloads(state.rows->constraints.pretension_sections, forces.shortenings, areas, pairs,
                                     *std::ranges::max_element(softest)));
  append(result, post::frictions_across_gaps(contact.states, pairs, forces.balance.acting, comm));
  append(result, post::pressing_overlaps(
                     {state.rows->constraints.contacts.nodes, contact.states, state.rows->initial_gaps, pairs, contact.surfaces},
                     2 * fields.stress.strain_energy, *std::ranges::min_element(softest), comm));
  append(result, post::strained_supports(support_loads(model, forces.reactions, comm), forces.balance.acting));
  append(result, post::point_forces(point_forces(model, state.rows->acts, forces), forces.balance.acting));
  if (verdict.solved())
    append(result, post::unreached_tolerance(accuracy.residuals, deck.solver.programme.tolerance.value.value_or(0),
                                             accuracy.algebraic_error));
  append(result, post::coarse_mesh(accuracy.mesh_error, names));
  append(result, post::coarse_secondaries(accuracy.contact_errors, accuracy.mesh_error.squared_norm, pairs));
  append(result, post::facet_push(forces.balance.push_of_facets, forces.balance.gauges));
  append(result, post::unresisted_loads(forces.unresisted, names));
  append(result, post::weak_stresses(applied_stresses(model, at_most(model), comm), fields.stress.largest_von_mises,
                                     *std::ranges::min_element(softest), names));
  append(result, short_searches(*state.rows, contact.states, comm));
  append(result, crossings(model, state.displacement, names, comm));
  for (auto& warning : result) warning.step = state.rows->acts.step;
  return result;
}

}  // namespace mortise::analysis
