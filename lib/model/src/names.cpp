// The names of a deck beside those of its mesh.
#include <fmt/format.h>

#include <algorithm>

#include "deck/description.hpp"
#include "mesh/curved_surface.hpp"
#include "model/deck.hpp"
#include "model/patterns.hpp"
#include "parts.hpp"

namespace mortise::model {

namespace {

// Why a boundary cannot be found, or "".
std::string missing(const std::string& name, const mesh::Catalogue& catalogue)
{
  const auto [boundary, body] = parse_boundary(name);
  const auto& known = catalogue.boundaries;
  if (std::find(known.begin(), known.end(), boundary) == known.end()) {
    std::vector<std::string> names;  // without those that patterns made, or the geometry
    std::copy_if(known.begin(), known.end(), std::back_inserter(names),
                 [](const auto& n) { return !is_pattern(n) && !mesh::curved_surface(n); });
    const auto& sets = catalogue.node_sets;
    if (std::any_of(sets.begin(), sets.end(), [&](const mesh::NodeSet& set) { return set.name == boundary; }))
      return fmt::format(
          "\"{0}\" is a curve, a point or a set of nodes of the mesh, not a boundary; supports and loads take it as "
          "`points: {0}`",
          boundary);
    return fmt::format("the mesh has no boundary \"{}\"{}", boundary, deck::suggestion(boundary, names));
  }
  if (body.empty()) return "";
  std::vector<std::string> bodies;
  for (const auto& b : catalogue.bodies)
    for (const auto& n : {b.name, b.instance, b.group})
      if (!n.empty() && std::find(bodies.begin(), bodies.end(), n) == bodies.end()) bodies.push_back(n);
  if (std::find(bodies.begin(), bodies.end(), body) == bodies.end())
    return fmt::format("the mesh has no body \"{}\"{}", body, deck::suggestion(body, bodies));
  return "";
}

// An entry of `bodies` with wild cards: it matches something, and no other such entry says otherwise of a body without its own.
void check_body_pattern(const Deck& deck, const std::string& pattern, const std::vector<std::string>& groups,
                        deck::Document& document)
{
  const auto text = [](const fem::BodyOptions& body) { return YAML::Dump(deck::Codec<fem::BodyOptions>::write(body)); };
  bool any = false;
  for (const auto& group : groups) {
    if (!matches(pattern, group)) continue;
    any = true;
    const auto used = body_entry(deck, group);
    if (used->first == group || used->first == pattern || text(used->second) == text(deck.bodies.at(pattern))) continue;
    document.error("bodies." + pattern, fmt::format("says something else of the body \"{}\" than \"{}\" does, which matches it "
                                                    "too; give \"{}\" an entry of its own",
                                                    group, used->first, group));
    return;
  }
  if (!any)
    document.error("bodies." + pattern,
                   fmt::format("no body of the mesh matches \"{}\"{}", pattern, deck::suggestion(pattern, groups)));
}

// Each entry of `bodies` has a body of the mesh, and each body an entry.
void check_entries_of_bodies(const Deck& deck, const std::vector<std::string>& groups, deck::Document& document)
{
  for (const auto& [name, body] : deck.bodies)
    if (is_pattern(name))
      check_body_pattern(deck, name, groups, document);
    else if (std::find(groups.begin(), groups.end(), name) == groups.end())
      document.error("bodies." + name,
                     fmt::format("the mesh has no body{} \"{}\"{}",
                                 body.method == fem::Method::boundary_elements ? " and no physical surface" : "", name,
                                 deck::suggestion(name, groups)));
  for (const auto& group : groups)
    if (body_entry(deck, group) == deck.bodies.end())
      document.error("bodies", fmt::format("the body \"{}\" of the mesh has no entry; give it a material", group));
}

// Why a body cannot take a load, or "".
std::string misfit(const Deck& deck, const fem::LoadOptions& load, const mesh::Body& body)
{
  const auto entry = body_entry(deck, body.group);
  if (entry == deck.bodies.end()) return "";
  const bool on_boundary_elements = entry->second.method == fem::Method::boundary_elements;
  if (load.centrifugal && on_boundary_elements)
    return fmt::format("centrifugal loads are for finite elements, and the body \"{}\" is of boundary elements", body.name);
  if (load.temperature_change && !load.temperature_change->is_constant() && on_boundary_elements)
    return fmt::format(
        "a temperature that varies is for finite elements, and the body \"{}\" is of boundary elements, which take a number",
        body.name);
  const auto of_body = [&](const auto& material) { return is_made_of(entry->second, material.first); };
  const auto light = std::find_if(deck.materials.begin(), deck.materials.end(),
                                  [&](const auto& material) { return of_body(material) && !(material.second.density > 0); });
  if ((load.acceleration || load.centrifugal) && light != deck.materials.end())
    return fmt::format("an acceleration needs a density > 0 of the material \"{}\"", light->first);
  const auto any = std::find_if(deck.materials.begin(), deck.materials.end(), of_body);
  const bool expands = std::any_of(deck.materials.begin(), deck.materials.end(),
                                   [&](const auto& material) { return of_body(material) && material.second.expands(); });
  if (load.temperature_change && any != deck.materials.end() && !expands)
    return fmt::format("a temperature_change needs a thermal_expansion (strain a degree) of the material \"{}\"", any->first);
  return "";
}

// The body that a load names is in the mesh, and takes it.
void check_loaded_bodies(const Deck& deck, const fem::LoadOptions& load, const std::string& path,
                         const std::vector<std::string>& groups, const mesh::Catalogue& catalogue, deck::Document& document)
{
  const auto is_meant = [&](const mesh::Body& body) { return matches_name(body, load.body); };
  if (std::none_of(catalogue.bodies.begin(), catalogue.bodies.end(), is_meant))
    document.error(path, fmt::format("the mesh has no body \"{}\"{}", load.body, deck::suggestion(load.body, groups)));
  for (const auto& body : catalogue.bodies) {
    if (!is_meant(body)) continue;
    if (const auto why = misfit(deck, load, body); !why.empty()) {
      document.error(path, why);
      break;
    }
  }
}

}  // namespace

void check_names(const Deck& deck, const Contacts& contacts, deck::Document& document, const mesh::Catalogue& catalogue)
{
  std::vector<std::string> groups;
  for (const auto& body : catalogue.bodies)
    if (std::find(groups.begin(), groups.end(), body.group) == groups.end()) groups.push_back(body.group);
  check_entries_of_bodies(deck, groups, document);
  check_volumes(deck, document, catalogue);

  const auto check = [&](const std::string& name, const std::string& path) {
    if (const auto why = missing(name, catalogue); !why.empty()) document.error(path, why);
  };
  for (const auto& [name, coupling] : deck.couplings) check(coupling.boundary, "couplings." + name + ".boundary");
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    if (!deck.supports[i].boundary.empty()) check(deck.supports[i].boundary, fmt::format("supports[{}].boundary", i));
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& load = deck.loads[i];
    if (!load.boundary.empty()) check(load.boundary, fmt::format("loads[{}].boundary", i));
    if (!load.body.empty() && load.points.empty())
      check_loaded_bodies(deck, load, fmt::format("loads[{}].body", i), groups, catalogue, document);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].automatic) continue;
    check(contacts[i].secondary, contacts.path(i) + ".secondary");
    if (!contacts[i].obstacle) check(contacts[i].primary, contacts.path(i) + ".primary");
  }
}

}  // namespace mortise::model
