#include "model/auto_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "contact/proximity.hpp"
#include "mesh/topology.hpp"
#include "model/model.hpp"
#include "model/patterns.hpp"
#include "partition/skin.hpp"
#include "side_bodies.hpp"

namespace mortise::model {

namespace {

std::size_t auto_entry(const std::vector<contact::Options>& contacts)
{
  const auto found = std::find_if(contacts.begin(), contacts.end(), [](const auto& contact) { return contact.automatic; });
  return static_cast<std::size_t>(found - contacts.begin());
}

// The bodies that the two sides of contacts lie on; the cuts of a sector say nothing of those that meet within it. Collective.
std::set<contact::Bodies> pairs_that_are_named(const std::vector<contact::Options>& contacts,
                                               const partition::Decomposition& decomposition, const Communicator& comm)
{
  const auto bodies = bodies_on_sides(contacts, decomposition, comm);
  std::set<contact::Bodies> pairs;
  for (const auto& [side, on] : bodies)
    if (const auto other = bodies.find(side + 1); side % 2 == 0 && other != bodies.end())
      for (const int a : on)
        for (const int b : other->second) pairs.insert(std::minmax(a, b));
  return pairs;
}

// The bodies that no contact names, but the one with most faces: its neighbours are asked. Collective.
std::vector<bool> unnamed_bodies(const mesh::Surface& skin, const std::set<contact::Bodies>& named, std::size_t bodies,
                                 const Communicator& comm)
{
  std::vector<double> faces(bodies, 0.0);
  for (const int body : skin.body) faces[static_cast<std::size_t>(body)] += 1;
  comm.sum_in_place(faces);
  std::vector<bool> result(bodies, true);
  result[static_cast<std::size_t>(std::max_element(faces.begin(), faces.end()) - faces.begin())] = false;
  for (const auto& [a, b] : named) result[static_cast<std::size_t>(a)] = result[static_cast<std::size_t>(b)] = false;
  return result;
}

// Of Young's modulus: from here on the softer side is secondary, whichever has the smaller faces; see post::scattered_contacts().
constexpr double stiffer = 4;

void swap_sides(contact::ContactCandidate& candidate)
{
  std::swap(candidate.secondary, candidate.primary);
  std::swap(candidate.secondary_faces, candidate.primary_faces);
  std::swap(candidate.secondary_facing, candidate.primary_facing);
}

// 0 for what rounding leaves of it.
double without_rounding(double gap, double reach)
{
  return std::abs(gap) < 1e-9 * reach ? 0 : gap;
}

// Adds a boundary of the outer faces with these numbers (of outer_surface()) for each of the lists.
void define_boundaries(const std::vector<std::pair<std::string, const std::vector<Global>*>>& boundaries,
                       partition::Decomposition& decomposition)
{
  auto& names = decomposition.catalogue.boundaries;
  std::vector<std::pair<Global, int>> members;  // face, boundary
  for (const auto& [name, faces] : boundaries) {
    for (const Global face : *faces) members.emplace_back(face, static_cast<int>(names.size()));
    names.push_back(name);
  }
  std::sort(members.begin(), members.end());
  for (auto& subdomain : decomposition.subdomains) {
    auto& mesh = subdomain.mesh;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      auto member = std::lower_bound(members.begin(), members.end(), std::pair(6 * mesh.cell_id[c], -1));
      for (; member != members.end() && member->first < 6 * mesh.cell_id[c] + 6; ++member) {
        const auto face =
            partition::face_of(subdomain, static_cast<Local>(c), static_cast<int>(member->first - 6 * mesh.cell_id[c]));
        mesh.facets.cells.add(face.type, face.nodes);
        mesh.facets.parent.push_back(static_cast<Local>(c));
        mesh.facets.boundary.push_back(member->second);
      }
    }
  }
}

}  // namespace

std::vector<contact::ContactCandidate> resolve_auto(const Deck& deck, Contacts& contacts, deck::Document& document,
                                                    partition::Decomposition& decomposition, const Context& context)
{
  const std::size_t place = auto_entry(contacts.options);
  if (place == contacts.size()) return {};
  const auto scope = context.timers.scope("contact");
  const auto entry = contacts[place];
  const auto& bodies = decomposition.catalogue.bodies;
  auto candidates = contact::find_contact_candidates(
      partition::outer_surface(decomposition, context.comm), static_cast<int>(bodies.size()),
      pairs_that_are_named(contacts.options, decomposition, context.comm), entry, deck.kinematics, context.comm);
  const auto modulus = [&](int body) { return least_modulus(deck, bodies[static_cast<std::size_t>(body)]); };
  for (auto& candidate : candidates)
    if (modulus(candidate.secondary) > stiffer * modulus(candidate.primary)) swap_sides(candidate);
  std::vector<contact::Options> found;
  std::vector<std::pair<std::string, const std::vector<Global>*>> boundaries;
  for (const auto& candidate : candidates) {
    auto& contact = found.emplace_back(entry);
    contact.name = fmt::format(
        "{}{}/{}{}", entry.name == "auto" ? "" : entry.name + ".", bodies[static_cast<std::size_t>(candidate.secondary)].name,
        bodies[static_cast<std::size_t>(candidate.primary)].name, candidate.patch > 0 ? fmt::format(".{}", candidate.patch) : "");
    std::string sides = contact.name;  // a colon in a body's name would part boundary from body
    std::replace(sides.begin(), sides.end(), ':', '_');
    contact.secondary = sides + ".secondary";
    contact.primary = sides + ".primary";
    contact.search_distance = candidate.reach;
    contact.automatic = false;
    boundaries.emplace_back(contact.secondary, &candidate.secondary_faces);
    boundaries.emplace_back(contact.primary, &candidate.primary_faces);
  }
  define_boundaries(boundaries, decomposition);

  const auto at = static_cast<std::ptrdiff_t>(place);
  const std::size_t own = contacts.entry[place];
  contacts.entry.erase(contacts.entry.begin() + at);
  contacts.entry.insert(contacts.entry.begin() + at, found.size(), own);
  contacts.options.erase(contacts.options.begin() + at);
  contacts.options.insert(contacts.options.begin() + at, found.begin(), found.end());
  check_contacts(contacts, deck.kinematics, document);
  return candidates;
}

std::optional<Warning> print_contact_candidates(const std::vector<contact::ContactCandidate>& candidates, const Deck& deck,
                                                const Contacts& contacts, const partition::Decomposition& decomposition, bool all,
                                                const Context& context)
{
  const std::size_t entry = auto_entry(deck.contacts);
  if (entry == deck.contacts.size()) return {};
  auto& log = context.log;
  const auto& bodies = decomposition.catalogue.bodies;
  if (!candidates.empty()) {
    const auto first = std::find(contacts.entry.begin(), contacts.entry.end(), entry) - contacts.entry.begin();
    constexpr std::size_t most = 40;
    const std::size_t count = all ? candidates.size() : std::min(most, candidates.size());
    for (std::size_t m = 0; m < count; ++m) {
      const auto& candidate = candidates[m];
      log.line("  found {}: {} + {} faces face each other, area {:.5g}, gaps {:.3g} to {:.3g}; search distance {:.3g}",
               contacts[static_cast<std::size_t>(first) + m].name, candidate.secondary_facing, candidate.primary_facing,
               candidate.area, without_rounding(candidate.least_gap, candidate.reach),
               without_rounding(candidate.largest_gap, candidate.reach), candidate.reach);
    }
    if (count < candidates.size()) log.line("  found {} more pairs, which --check lists", candidates.size() - count);
    return {};
  }
  const auto skin = partition::outer_surface(decomposition, context.comm);
  const double given_distance = deck.contacts[entry].search_distance;
  const auto distance = given_distance > 0 ? fmt::format("search_distance {:.4g}", given_distance)
                                           : fmt::format("half the size of their faces, which is at most {:.4g}",
                                                         contact::widest_distance(skin, context.comm));
  const auto alone =
      unnamed_bodies(skin, pairs_that_are_named(contacts.options, decomposition, context.comm), bodies.size(), context.comm);
  const auto nearest = contact::nearest_bodies(skin, alone, context.comm);
  const auto best =
      std::min_element(nearest.begin(), nearest.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
  const auto which = best == nearest.end() || best->body < 0
                         ? std::string("there are no others")
                         : fmt::format("the nearest are \"{}\" and \"{}\", {:.4g} apart",
                                       bodies[static_cast<std::size_t>(best - nearest.begin())].name,
                                       bodies[static_cast<std::size_t>(best->body)].name, best->distance);
  return Warning{"no_pair_found",
                 fmt::format("{}: no pair of bodies{} faces each other within {}; {}", as_written(deck).path(entry),
                             deck.contacts.size() > 1 ? " that no other contact names" : "", distance, which),
                 "set a larger search_distance, or name the boundaries"};
}

}  // namespace mortise::model
