#include "model/deck.hpp"

#include <filesystem>
#include <numeric>

#include "deck/description.hpp"
#include "deck_checks.hpp"
#include "sectors.hpp"
#include "model/patterns.hpp"
#include "parts.hpp"

namespace mortise::model {

namespace {

namespace fs = std::filesystem;

const std::map<std::string, fem::Kinematics>& dimensions()
{
  static const std::map<std::string, fem::Kinematics> table{{"3", fem::Kinematics::solid},
                                                            {"plane_strain", fem::Kinematics::plane_strain},
                                                            {"plane_stress", fem::Kinematics::plane_stress},
                                                            {"axisymmetric", fem::Kinematics::axisymmetric}};
  return table;
}

void read_dimension(Deck& deck, const YAML::Node& node, const std::string& path, deck::Document& document,
                    const deck::Limits& limits)
{
  std::string name;
  const auto before = document.error_count();
  deck::Codec<std::string>::read(name, node, path, document, limits);
  if (document.error_count() == before) deck.kinematics = dimensions().at(name);
}

YAML::Node write_dimension(const Deck& deck)
{
  for (const auto& [name, kinematics] : dimensions())
    if (kinematics == deck.kinematics) return YAML::Node(name);
  return {};
}

nlohmann::ordered_json dimension_schema(const deck::Limits& limits)
{
  nlohmann::ordered_json names = limits.names;
  names.push_back(3);
  return {{"enum", names}};
}

}  // namespace

Contacts as_written(const Deck& deck)
{
  Contacts contacts{deck.contacts, std::vector<std::size_t>(deck.contacts.size())};
  std::iota(contacts.entry.begin(), contacts.entry.end(), 0U);
  return contacts;
}

void describe(deck::Description<SolverOptions>& d)
{
  d.help("How the problem is solved.");
  // The keys of both modules, as keys of the whole.
  const auto adopt = [&d](const auto& part, auto member) {
    for (const auto& key : part.keys()) {
      const auto* source = key.get();
      auto& own = d.custom(
          source->name, source->help,
          [source, member](SolverOptions& value, const YAML::Node& node, const std::string& path, deck::Document& document,
                           const deck::Limits& limits) { source->read(value.*member, node, path, document, limits); },
          [source, member](const SolverOptions& value) { return source->write(value.*member); }, source->schema);
      own.limits = source->limits;
    }
  };
  adopt(deck::description<qp::Options>(), &SolverOptions::programme);
  adopt(deck::description<feti::Options>(), &SolverOptions::subdomains);
}

void describe(deck::Description<Deck>& d)
{
  d.help("A Mortise deck: one contact problem of linear elasticity. Any consistent set of units.");
  d.key("title", &Deck::title, "One line that says what is solved.");
  d.custom("dimension",
           "3, plane_strain, plane_stress or axisymmetric: meshes in x, y; x is the radius, y the axis of revolution.",
           read_dimension, write_dimension, dimension_schema)
      .one_of({"3", "plane_strain", "plane_stress", "axisymmetric"});
  d.key("mesh", &Deck::mesh, "The mesh.").required();
  d.key("materials", &Deck::materials, "Materials by name.").required();
  d.key("bodies", &Deck::bodies,
        "One entry for each physical volume (plane models: surface) of the mesh, by its name; a `*` stands for any text, and an "
        "entry "
        "of the whole name goes before one with `*`.")
      .required();
  d.key("axes", &Deck::axes, "Local axes by names that supports and loads refer to.");
  d.key("couplings", &Deck::couplings, "Boundaries coupled to points, by names that loads and supports refer to.");
  d.key("supports", &Deck::supports, "Prescribed displacements, and springs to the ground.");
  d.key("springs", &Deck::springs, "Springs between points of bodies, by names.");
  d.key("loads", &Deck::loads, "Loads.");
  d.custom(
      "contacts",
      "Pairs of boundaries that may touch; a pair that is not named passes through each other. `auto`, or an entry {auto: true} "
      "among others, finds them.",
      [](Deck& deck, const YAML::Node& node, const std::string& path, deck::Document& document, const deck::Limits&) {
        contact::read_section(deck.contacts, node, path, document);
      },
      [](const Deck& deck) { return contact::write_section(deck.contacts); },
      [](const deck::Limits&) { return contact::section_schema(); });
  d.key("steps", &Deck::steps, "Load steps, one after the other; without any all loads act at once.");
  d.key("decomposition", &Deck::decomposition, "How bodies are cut into subdomains.");
  d.key("solver", &Deck::solver, "How the problem is solved.");
  d.key("friction_loop", &Deck::friction_loop, "The fixed point of Coulomb friction.");
  d.key("output", &Deck::output, "What is written where.");
}

namespace {

// Of nodes that a support or a load names: that of the mesh if it is one.
std::string name_of(const std::vector<deck::Place>& points)
{
  return points.size() == 1 && !points[0].name.empty() ? points[0].name : "points";
}

}  // namespace

Deck read_deck(deck::Document& document, const std::string& output)
{
  Deck deck;
  deck::read(deck, document);
  for (auto& contact : deck.contacts)
    if (contact.name.empty())
      contact.name = contact.automatic ? "auto"
                                       : contact.secondary + "/" +
                                             (contact.obstacle ? contact::shape_name(*contact.obstacle) : contact.primary);
  for (auto& support : deck.supports)
    if (support.name.empty())
      support.name = !support.coupling.empty() ? support.coupling
                     : !support.points.empty() ? name_of(support.points)
                                               : support.boundary;
  for (auto& load : deck.loads)
    if (load.name.empty())
      load.name = !load.coupling.empty()  ? load.coupling
                  : !load.points.empty()  ? name_of(load.points)
                  : load.boundary.empty() ? load.body
                                          : load.boundary;
  check_bodies(deck, document);
  describe_assembly(deck, document);
  check_decomposition(deck, document);
  check_solver(deck, document);
  check_vectors(deck, document);
  check_couplings(deck, document);
  check_axes(deck, document);
  check_sectors(deck, document);
  check_formulas_of_rings(deck, document);
  check_contacts(as_written(deck), deck.kinematics, document);
  check_steps(deck, document);
  auto& decomposition = deck.decomposition;
  if (decomposition.method == "metis" && !decomposition.subdomains && !decomposition.unknowns_per_subdomain)
    decomposition.unknowns_per_subdomain = deck.axisymmetric() ? partition::usual_size_of_rings : partition::usual_size;

  const auto file = fs::absolute(document.file()).lexically_normal();
  if (!deck.mesh.file.empty()) deck.mesh.file = (file.parent_path() / deck.mesh.file).lexically_normal().string();
  if (auto& points = deck.output.interior.point_file; !points.empty())
    points = (file.parent_path() / points).lexically_normal().string();
  for (auto& load : deck.loads)
    if (load.temperature_change && load.temperature_change->file)
      load.temperature_change->file->file =
          (file.parent_path() / load.temperature_change->file->file).lexically_normal().string();
  if (!output.empty())
    deck.output.directory = fs::absolute(output).lexically_normal().string();
  else if (deck.output.directory.empty())
    deck.output.directory = (file.parent_path() / (file.stem().string() + ".out")).string();
  else
    deck.output.directory = (file.parent_path() / deck.output.directory).lexically_normal().string();
  if ((fs::path(deck.output.directory) / "deck.yaml").lexically_normal() == file)
    document.error("output.directory", "the results hold a deck.yaml, which would replace this deck; choose another directory");
  return deck;
}

std::vector<bool> bodies_of_boundary_elements(const Deck& deck, const mesh::Catalogue& catalogue)
{
  std::vector<bool> result;
  for (const auto& body : catalogue.bodies) {
    const auto entry = body_entry(deck, body.group);
    result.push_back(entry != deck.bodies.end() && entry->second.method == fem::Method::boundary_elements);
  }
  return result;
}

BoundaryName parse_boundary(const std::string& name)
{
  const auto colon = is_pattern(name) ? std::string::npos : name.find(':');
  if (colon == std::string::npos) return {name, {}};
  return {name.substr(colon + 1), name.substr(0, colon)};
}

deck::LocalAxes local_axes(const Deck& deck, const std::string& name)
{
  return deck::LocalAxes(deck.axes.at(name), deck.dimension() == 2);
}

std::string write_deck(const Deck& deck)
{
  YAML::Emitter out;
  out << deck::Codec<Deck>::write(deck);
  return std::string(out.c_str()) + "\n";
}

std::string deck_schema()
{
  return deck::schema<Deck>("urn:mortise:deck").dump(2) + "\n";
}

}  // namespace mortise::model
