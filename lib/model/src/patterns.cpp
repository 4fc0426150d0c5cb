#include "model/patterns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "mesh/curved_surface.hpp"

namespace mortise::model {

namespace {

// A boundary (of the catalogue) on a body; -1: on all.
struct BodyBoundary {
  int boundary;
  int body;
};

// What patterns can match, in the order of the mesh.
struct Candidates {
  std::vector<std::string> boundaries;  // their place is that in the catalogue; empty: not for users (curved_surface.hpp)
  std::vector<std::pair<std::string, BodyBoundary>> on_bodies;  // body:boundary
};

Candidates candidates(const partition::Decomposition& decomposition, bool with_bodies, const Communicator& comm)
{
  Candidates result{decomposition.catalogue.boundaries, {}};
  for (auto& name : result.boundaries)
    if (mesh::curved_surface(name)) name.clear();  // keeps its place
  if (!with_bodies) return result;
  std::set<std::pair<int, int>> own;  // body, boundary
  for (const auto& subdomain : decomposition.subdomains)
    for (const int boundary : subdomain.mesh.facets.boundary) own.emplace(subdomain.body, boundary);
  std::vector<int> flat;
  for (const auto& [body, boundary] : own) flat.insert(flat.end(), {body, boundary});
  own.clear();
  const auto all = comm.all_gather(flat);
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) own.emplace(all[i], all[i + 1]);
  for (const auto& [body, boundary] : own) {
    if (result.boundaries[static_cast<std::size_t>(boundary)].empty()) continue;
    const auto& b = decomposition.catalogue.bodies[static_cast<std::size_t>(body)];
    result.on_bodies.emplace_back(
        (b.instance.empty() ? b.name : b.instance) + ":" + result.boundaries[static_cast<std::size_t>(boundary)],
        BodyBoundary{boundary, body});
  }
  return result;
}

// The names that a pattern means, each once, in order.
std::vector<std::string> names_for(const std::string& pattern, const Candidates& candidates)
{
  std::vector<std::string> names;
  if (pattern.find(':') == std::string::npos) {
    for (const auto& name : candidates.boundaries)
      if (!name.empty() && matches(pattern, name)) names.push_back(name);
    return names;
  }
  std::set<std::string> seen;
  for (const auto& [name, place] : candidates.on_bodies)
    if (matches(pattern, name) && seen.insert(name).second) names.push_back(name);
  return names;
}

std::vector<BodyBoundary> boundaries_for(const std::string& pattern, const Candidates& candidates)
{
  std::vector<BodyBoundary> places;
  if (pattern.find(':') == std::string::npos) {
    for (std::size_t b = 0; b < candidates.boundaries.size(); ++b)
      if (!candidates.boundaries[b].empty() && matches(pattern, candidates.boundaries[b]))
        places.push_back({static_cast<int>(b), -1});
    return places;
  }
  for (const auto& [name, place] : candidates.on_bodies)
    if (matches(pattern, name)) places.push_back(place);
  return places;
}

void report_no_match(const std::string& pattern, const std::string& path, const Candidates& candidates, deck::Document& document)
{
  std::vector<std::string> names;
  if (pattern.find(':') == std::string::npos)
    std::copy_if(candidates.boundaries.begin(), candidates.boundaries.end(), std::back_inserter(names),
                 [](const std::string& name) { return !name.empty(); });
  else
    for (const auto& [name, place] : candidates.on_bodies) names.push_back(name);
  document.error(path, fmt::format("no boundary of the mesh matches \"{}\"{}", pattern, deck::suggestion(pattern, names)));
}

// A new boundary with all faces of `places`, once each.
void define_boundary(const std::string& name, const std::vector<BodyBoundary>& places, partition::Decomposition& decomposition)
{
  const auto index = static_cast<int>(decomposition.catalogue.boundaries.size());
  decomposition.catalogue.boundaries.push_back(name);
  for (auto& subdomain : decomposition.subdomains) {
    auto& facets = subdomain.mesh.facets;
    std::set<std::pair<Local, std::vector<Local>>> taken;  // cell, nodes
    for (std::size_t f = 0, count = facets.cells.size(); f < count; ++f) {
      const bool meant = std::any_of(places.begin(), places.end(), [&](const BodyBoundary& place) {
        return place.boundary == facets.boundary[f] && (place.body < 0 || place.body == subdomain.body);
      });
      const std::vector<Local> nodes(facets.cells[f].begin(), facets.cells[f].end());
      if (!meant || !taken.emplace(facets.parent[f], nodes).second) continue;
      facets.cells.add(facets.cells.type[f], nodes);
      facets.parent.push_back(facets.parent[f]);
      facets.boundary.push_back(index);
    }
  }
}

// The contacts that one entry with wild cards stands for.
std::vector<contact::Options> matching_contacts(const contact::Options& entry, const std::string& path,
                                                const Candidates& candidates, deck::Document& document)
{
  const auto stars = [](const std::string& name) { return std::count(name.begin(), name.end(), '*'); };
  if (!is_pattern(entry.secondary)) {
    document.error(path + ".primary",
                   fmt::format("the `*` of \"{}\" stands for what that of the secondary stands for, but \"{}\" has none",
                               entry.primary, entry.secondary));
    return {};
  }
  if (stars(entry.secondary) > 1 || stars(entry.primary) > 1) {
    document.error(path, "a contact's boundaries have at most one `*` each");
    return {};
  }
  const auto names = names_for(entry.secondary, candidates);
  if (names.empty()) report_no_match(entry.secondary, path + ".secondary", candidates, document);
  std::vector<contact::Options> contacts;
  for (const auto& name : names) {
    const auto text = *wildcard_text(entry.secondary, name);
    contact::Options contact = entry;
    contact.secondary = name;
    if (const auto star = contact.primary.find('*'); star != std::string::npos) contact.primary.replace(star, 1, text);
    contact.name =
        entry.name == entry.secondary + "/" + entry.primary ? contact.secondary + "/" + contact.primary : entry.name + "." + text;
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

}  // namespace

bool is_pattern(const std::string& name)
{
  return name.find('*') != std::string::npos;
}

bool matches(const std::string& pattern, const std::string& text)
{
  std::size_t p = 0, t = 0, star = std::string::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::optional<std::string> wildcard_text(const std::string& pattern, const std::string& text)
{
  const auto star = pattern.find('*');
  const std::size_t rest = pattern.size() - star - 1;
  if (text.size() < star + rest || !matches(pattern, text)) return {};
  return text.substr(star, text.size() - star - rest);
}

bool matches_name(const mesh::Body& body, const std::string& name)
{
  if (is_pattern(name)) return matches(name, body.name) || matches(name, body.instance) || matches(name, body.group);
  return body.name == name || body.group == name || (!name.empty() && body.instance == name);
}

std::map<std::string, fem::BodyOptions>::const_iterator body_entry(const Deck& deck, const std::string& group)
{
  if (const auto own = deck.bodies.find(group); own != deck.bodies.end()) return own;
  return std::find_if(deck.bodies.begin(), deck.bodies.end(),
                      [&](const auto& entry) { return is_pattern(entry.first) && matches(entry.first, group); });
}

Contacts resolve_patterns(const Deck& deck, deck::Document& document, partition::Decomposition& decomposition,
                          const Communicator& comm)
{
  bool any = false, with_bodies = false;
  const auto note = [&](const std::string& name) {
    any = any || is_pattern(name);
    with_bodies = with_bodies || (is_pattern(name) && name.find(':') != std::string::npos);
  };
  for (const auto& [name, coupling] : deck.couplings) note(coupling.boundary);
  for (const auto& support : deck.supports) note(support.boundary);
  for (const auto& load : deck.loads) note(load.boundary);
  for (const auto& contact : deck.contacts) {
    note(contact.secondary);
    note(contact.primary);
  }
  if (!any) return as_written(deck);
  const auto known = candidates(decomposition, with_bodies, comm);

  Contacts contacts;
  for (std::size_t i = 0; i < deck.contacts.size(); ++i) {
    const auto& entry = deck.contacts[i];
    const bool pattern = is_pattern(entry.secondary) || is_pattern(entry.primary);
    const auto own = pattern ? matching_contacts(entry, fmt::format("contacts[{}]", i), known, document) : std::vector{entry};
    contacts.options.insert(contacts.options.end(), own.begin(), own.end());
    contacts.entry.resize(contacts.size(), i);
  }
  check_contacts(contacts, deck.kinematics, document);

  std::set<std::string> defined;
  const auto resolve = [&](const std::string& name, const std::string& path) {
    if (!is_pattern(name) || !defined.insert(name).second) return;
    const auto places = boundaries_for(name, known);
    if (places.empty()) report_no_match(name, path, known, document);
    define_boundary(name, places, decomposition);
  };
  for (const auto& [name, coupling] : deck.couplings) resolve(coupling.boundary, "couplings." + name + ".boundary");
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    resolve(deck.supports[i].boundary, fmt::format("supports[{}].boundary", i));
  for (std::size_t i = 0; i < deck.loads.size(); ++i) resolve(deck.loads[i].boundary, fmt::format("loads[{}].boundary", i));
  return contacts;
}

}  // namespace mortise::model
