#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "model/patterns.hpp"

namespace mortise::model {

namespace {

// Motions that a plane or axisymmetric model does not have.
void check_motions(const std::vector<mesh::InstanceOptions>& instances, const std::string& path, bool axisymmetric,
                   deck::Document& document)
{
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const auto& entry = instances[i];
    const auto at = fmt::format("{}[{}]", path, i);
    if (entry.translate[2] != 0) document.error(at + ".translate", "a plane model has no z component");
    if (axisymmetric && entry.translate[0] != 0)
      document.error(at + ".translate", "an axisymmetric body is moved along its axis, y, alone; expected 0 for x");
    if (entry.rotate && axisymmetric)
      document.error(at + ".rotate", "an axisymmetric body cannot be rotated: it goes round the axis of revolution");
    else if (entry.rotate && (entry.rotate->axis[0] != 0 || entry.rotate->axis[1] != 0))
      document.error(at + ".rotate.axis", "a plane model turns about z; expected [0, 0, 1]");
    check_motions(entry.of, at + ".of", axisymmetric, document);
  }
}

// Where bodies are, and of what parts, is said before there is a mesh to match patterns with.
void check_patterns(const Deck& deck, deck::Document& document)
{
  for (const auto& [name, body] : deck.bodies) {
    if (!is_pattern(name)) continue;
    for (const auto& [key, given] : {std::pair("instances", !body.instances.empty()), std::pair("volumes", !body.volumes.empty()),
                                     std::pair("surfaces", !body.surfaces.empty())})
      if (given)
        document.error("bodies." + name + "." + key,
                       fmt::format("{} are of one body; expected its name instead of the pattern \"{}\"", key, name));
  }
}

void describe_instances(Deck& deck, deck::Document& document)
{
  for (const auto& [name, body] : deck.bodies) {
    if (body.instances.empty() || is_pattern(name)) continue;
    const auto path = "bodies." + name + ".instances";
    if (deck.dimension() == 2) check_motions(body.instances, path, deck.axisymmetric(), document);
    if (const double count = mesh::count_of(body.instances); count > mesh::most_instances) {
      document.error(path, fmt::format("makes {:.10g} copies; at most {} are possible", count, mesh::most_instances));
      continue;
    }
    auto motions = mesh::motions(body.instances);
    if (const auto same = mesh::coinciding(motions))
      document.error(path,
                     fmt::format("copies {} and {} lie in the same place; one of them is too many (a full circle of n copies "
                                 "takes `count: n` and `angle: 360/n`)",
                                 same->first + 1, same->second + 1));
    deck.mesh.instances.emplace(name, std::move(motions));
  }
}

void describe_surfaces(Deck& deck, deck::Document& document)
{
  std::map<std::string, std::string> owner;
  for (const auto& [name, body] : deck.bodies) {
    const auto path = "bodies." + name;
    if (body.method == fem::Method::boundary_elements) {
      if (deck.mesh.file.empty() && !body.surfaces.empty())
        document.error(path + ".surfaces", "blocks have cells; surfaces are for a mesh from a `file`");
      for (const auto& surface : body.surfaces)
        if (const auto [at, fresh] = owner.emplace(surface, name); !fresh)
          document.error(path + ".surfaces", fmt::format("\"{}\" encloses the body \"{}\" already", surface, at->second));
      if (!deck.mesh.file.empty() && !is_pattern(name)) deck.mesh.surfaces.emplace(name, body.surfaces);
    } else if (deck.mesh.dimension && *deck.mesh.dimension < deck.dimension()) {
      document.error(path + ".method",
                     fmt::format("with `mesh.dimension` {} there are no cells of bodies, but of their surfaces; expected "
                                 "boundary_elements, or `mesh.dimension: {}`",
                                 *deck.mesh.dimension, deck.dimension()));
    }
  }
  if (const auto cells = deck.mesh.dimension.value_or(deck.dimension()); cells > deck.dimension() || cells < deck.dimension() - 1)
    document.error("mesh.dimension", fmt::format("is {} in a model of dimension {}; expected {}, or {} for surfaces alone", cells,
                                                 deck.dimension(), deck.dimension(), deck.dimension() - 1));
}

}  // namespace

void describe_assembly(Deck& deck, deck::Document& document)
{
  check_patterns(deck, document);
  describe_instances(deck, document);
  describe_surfaces(deck, document);
  std::map<std::string, std::string> owner;
  for (const auto& [name, body] : deck.bodies) {
    if (is_pattern(name)) continue;
    for (const auto& [volume, material] : body.volumes) {
      const auto path = "bodies." + name + ".volumes." + volume;
      if (const auto [at, fresh] = owner.emplace(volume, name); !fresh)
        document.error(path, fmt::format("is already a volume of the body \"{}\"; a volume belongs to one body", at->second));
      if (volume != name && deck.bodies.contains(volume))
        document.error(path, fmt::format("is a body of its own in `bodies.{}`; a volume belongs to one body", volume));
      deck.mesh.volumes[name].push_back(volume);
    }
  }
  if (deck.mesh.file.empty() && !owner.empty())
    document.error(
        "bodies." + owner.begin()->second + ".volumes",
        "blocks share no nodes, so that they cannot form one body; take a mesh from a `file`, or tie blocks by a contact "
        "with `friction: {bonded: true}`");
}

void check_volumes(const Deck& deck, deck::Document& document, const mesh::Catalogue& catalogue)
{
  const auto& known = catalogue.volumes;
  for (const auto& [name, body] : deck.bodies) {
    if (body.volumes.empty() || is_pattern(name)) continue;
    for (const auto& [volume, material] : body.volumes)
      if (std::find(known.begin(), known.end(), volume) == known.end())
        document.error("bodies." + name + ".volumes." + volume,
                       fmt::format("the mesh has no physical volume \"{}\"{}", volume, deck::suggestion(volume, known)));
    if (!body.volumes.contains(name) && std::find(known.begin(), known.end(), name) != known.end())
      document.error(
          "bodies." + name + ".volumes",
          fmt::format("the mesh has a physical volume \"{}\" as well; list it here, or give the body another name", name));
  }
}

bool is_made_of(const fem::BodyOptions& body, const std::string& material)
{
  if (body.volumes.empty()) return body.material == material;
  return std::any_of(body.volumes.begin(), body.volumes.end(), [&](const auto& volume) { return volume.second == material; });
}

std::optional<mesh::Motion> motion_of(const mesh::Body& body, const Deck& deck)
{
  const auto copies = deck.mesh.instances.find(body.group);
  if (body.instance.empty() || copies == deck.mesh.instances.end()) return {};
  std::size_t number = 0;  // group.number, from 1
  const char* end = body.instance.data() + body.instance.size();
  std::from_chars(body.instance.data() + body.group.size() + 1, end, number);
  return copies->second.at(number - 1);
}

}  // namespace mortise::model
