#include "model/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>

#include "contact/cyclic.hpp"
#include "deck/description.hpp"
#include "mesh/curved_surface.hpp"
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

std::vector<std::string> keys_of(const auto& map)
{
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

void check_boundary_elements(const Deck& deck, const std::string& name, const fem::BodyOptions& body, deck::Document& document)
{
  if (deck.axisymmetric())
    document.error("bodies." + name + ".method",
                   "boundary elements are not for axisymmetric models; expected finite_elements, or another `dimension`");
  const auto material = deck.materials.find(body.material);
  if (material != deck.materials.end() && material->second.orthotropic)
    document.error(
        "bodies." + name + ".method",
        fmt::format("boundary elements are for isotropic materials, and \"{}\" is orthotropic; expected finite_elements",
                    body.material));
  if (deck.kinematics == fem::Kinematics::plane_stress && material != deck.materials.end() &&
      material->second.poisson_ratio <= -0.5)
    document.error("bodies." + name + ".method",
                   fmt::format("boundary elements in plane stress need a Poisson's ratio above -0.5, found {:.6g}; expected "
                               "finite_elements",
                               material->second.poisson_ratio));
}

// Mesh, bodies and materials.
void check_bodies(const Deck& deck, deck::Document& document)
{
  const auto check_material = [&](const std::string& material, const std::string& path) {
    if (!material.empty() && !deck.materials.contains(material))
      document.error(path,
                     fmt::format("there is no material \"{}\"{}", material, deck::suggestion(material, keys_of(deck.materials))));
  };
  for (const auto& [name, body] : deck.bodies) {
    check_material(body.material, "bodies." + name + ".material");
    for (const auto& [volume, material] : body.volumes) check_material(material, "bodies." + name + ".volumes." + volume);
  }
  for (const auto& [name, body] : deck.bodies)
    if (body.formulation == fem::Formulation::bbar && deck.kinematics == fem::Kinematics::plane_stress)
      document.error("bodies." + name + ".formulation",
                     "nothing locks in plane stress, where the thickness is free; expected standard");
  for (const auto& [name, body] : deck.bodies)
    if (body.formulation == fem::Formulation::incompatible && deck.axisymmetric())
      document.error("bodies." + name + ".formulation",
                     "the incompatible modes are for boxes, not for rings; expected standard or bbar, or cells of second order");
  for (const auto& [name, body] : deck.bodies) {
    const auto names = material_names(body);
    const auto orthotropic = std::find_if(names.begin(), names.end(), [&](const std::string& material) {
      const auto found = deck.materials.find(material);
      return found != deck.materials.end() && found->second.orthotropic;
    });
    if (orthotropic == names.end()) continue;
    if (body.formulation == fem::Formulation::bbar)
      document.error(
          "bodies." + name + ".formulation",
          fmt::format("bbar is for isotropic materials, and \"{}\" is orthotropic; expected standard, or cells of second "
                      "order",
                      *orthotropic));
    if (!body.instances.empty())
      document.error(
          "bodies." + name + ".instances",
          fmt::format("\"{}\" is orthotropic along axes in space, which would not turn with the copies; mesh the bodies "
                      "one by one",
                      *orthotropic));
  }
  for (const auto& [name, body] : deck.bodies)
    if (body.method == fem::Method::boundary_elements) check_boundary_elements(deck, name, body, document);
  for (const auto& [name, block] : deck.mesh.blocks) {
    const auto type = mesh::cell_type(block.element);
    if (type && mesh::dimension(*type) != deck.dimension())
      document.error("mesh.blocks." + name + ".element",
                     fmt::format("\"{}\" does not fit a model of dimension {}; expected {}", block.element,
                                 deck.dimension() == 2 ? "2" : "3",
                                 deck.dimension() == 2 ? "quad4, tri3, quad8, quad9 or tri6"
                                                       : "hex8, tet4, prism6, hex20, hex27, tet10, prism15 or prism18"));
  }
}

void check_decomposition(const Deck& deck, deck::Document& document)
{
  if (deck.decomposition.subdomains_per_cluster > 1)
    for (const auto& [name, body] : deck.bodies)
      if (body.method == fem::Method::boundary_elements) {
        document.error(
            "decomposition.subdomains_per_cluster",
            fmt::format("clusters are for finite elements, and the body \"{}\" is of boundary elements; expected 1", name));
        break;
      }
  if (deck.decomposition.method != "grid") {
    if (!deck.decomposition.counts.empty()) document.error("decomposition.counts", "counts are for `method: grid`");
    return;
  }
  if (!deck.mesh.file.empty()) {
    document.error("decomposition.method", "\"grid\" is for blocks only; use metis for a mesh from a file");
    return;
  }
  for (const auto& [name, block] : deck.mesh.blocks) {
    const auto counts = deck.decomposition.counts.find(name);
    if (counts == deck.decomposition.counts.end()) {
      document.error("decomposition.counts", fmt::format("the block \"{}\" needs an entry", name));
      continue;
    }
    for (int axis = 0; axis < deck.dimension(); ++axis) {
      const auto c = static_cast<std::size_t>(axis);
      if (counts->second[c] < 1 || counts->second[c] > block.cells[c])
        document.error("decomposition.counts." + name, fmt::format("expected 1 to {} subdomains along {}, found {}",
                                                                   block.cells[c], "xyz"[axis], counts -> second[c]));
    }
  }
  for (const auto& [name, counts] : deck.decomposition.counts)
    if (!deck.mesh.blocks.contains(name))
      document.error("decomposition.counts." + name,
                     "there is no such block" + deck::suggestion(name, keys_of(deck.mesh.blocks)));
}

void check_vectors(const Deck& deck, deck::Document& document)
{
  if (deck.dimension() == 3) {
    for (const auto& path : document.pairs()) document.error(path, "expected 3 entries, since `dimension` is 3, found 2");
    return;
  }
  const auto flat = [&](const std::optional<std::array<double, 3>>& v, const std::string& path) {
    if (v && (*v)[2] != 0) document.error(path, "a plane model has no z component");
  };
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto path = fmt::format("loads[{}].", i);
    if (const auto& traction = deck.loads[i].traction;
        traction && !((*traction)[2].is_constant() && (*traction)[2].constant() == 0))
      document.error(path + "traction", "a plane model has no z component");
    if (const auto& turning = deck.loads[i].centrifugal) {
      const auto& axis = turning->axis;
      const auto& at = turning->point;
      if (deck.axisymmetric() ? axis[0] != 0 || axis[2] != 0 || at[0] != 0 || at[2] != 0 : axis[0] != 0 || axis[1] != 0)
        document.error(path + "centrifugal", deck.axisymmetric()
                                                 ? "an axisymmetric body turns about its axis; expected axis: [0, 1, 0]"
                                                 : "a plane model turns about z; expected axis: [0, 0, 1]");
    }
    flat(deck.loads[i].force, path + "force");
    for (std::size_t k = 0; k < deck.loads[i].points.size(); ++k)
      flat(deck.loads[i].points[k].at, fmt::format("{}points[{}]", path, k));
    if (deck.axisymmetric() && !deck.loads[i].points.empty())
      document.error(path + "points", "in an axisymmetric model a point is a ring; load a boundary");
    flat(deck.loads[i].acceleration, path + "acceleration");
    if (const auto& moment = deck.loads[i].moment; moment && ((*moment)[0] != 0 || (*moment)[1] != 0))
      document.error(path + "moment", "in a plane model a moment turns about z alone; expected [0, 0, m]");
    if (deck.axisymmetric() && deck.loads[i].acceleration && (*deck.loads[i].acceleration)[0] != 0)
      document.error(path + "acceleration", "an axisymmetric body is accelerated along its axis, y, alone; expected 0 for x");
  }
  for (std::size_t i = 0; i < deck.supports.size(); ++i) {
    if (deck.supports[i].displacement[2])
      document.error(fmt::format("supports[{}].displacement.{}", i, deck.supports[i].cylindrical ? "axial" : "z"),
                     "a plane model has no z component");
    for (std::size_t k = 0; k < deck.supports[i].points.size(); ++k)
      flat(deck.supports[i].points[k].at, fmt::format("supports[{}].points[{}]", i, k));
    if (deck.supports[i].stiffness.along[2])
      document.error(fmt::format("supports[{}].stiffness.z", i), "a plane model has no z component");
    for (const std::size_t c : {0, 1})
      if (deck.supports[i].rotation[c])
        document.error(fmt::format("supports[{}].rotation.{}", i, "xy"[c]), "in a plane model points turn about z alone");
  }
  for (const auto& [name, spring] : deck.springs) {
    for (std::size_t k = 0; k < spring.points.size(); ++k)
      flat(spring.points[k].at, fmt::format("springs.{}.points[{}]", name, k));
    if (deck.axisymmetric())
      document.error("springs." + name, "in an axisymmetric model a point is a ring; give a boundary a `stiffness`");
  }
  const auto& interior = deck.output.interior;
  for (std::size_t i = 0; i < interior.points.size(); ++i) flat(interior.points[i], fmt::format("output.interior.points[{}]", i));
  if (!interior.planes.empty()) document.error("output.interior.planes", "sections are for models of dimension 3");
  for (const auto& [name, probe] : deck.output.probes) {
    flat(probe.point, "output.probes." + name + ".point");
    flat(probe.from, "output.probes." + name + ".from");
    flat(probe.to, "output.probes." + name + ".to");
  }
  flat(deck.output.moments_about, "output.moments_about");
}

// Whether a formula has a variable of this name.
bool has_variable(const deck::Formula& formula, const std::string& name)
{
  const auto& text = formula.text();
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const bool begins = at == 0 || !is_of_word(text[at - 1]);
    const bool ends = at + name.size() == text.size() || !is_of_word(text[at + name.size()]);
    if (begins && ends) return true;
  }
  return false;
}

// r and theta are polar coordinates of x and y, which are the radius and the axis there.
void check_formulas_of_rings(const Deck& deck, deck::Document& document)
{
  if (!deck.axisymmetric()) return;
  const auto check = [&](const std::vector<deck::Formula>& formulas, const std::string& path) {
    for (const auto& formula : formulas)
      for (const char* name : {"r", "theta"})
        if (has_variable(formula, name))
          document.error(path, fmt::format("\"{}\": in an axisymmetric model the radius is x and the axis is y; write x for r",
                                           formula.text()));
  };
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    std::vector<deck::Formula> formulas;
    if (deck.loads[i].pressure) formulas.push_back(*deck.loads[i].pressure);
    if (const auto& traction = deck.loads[i].traction) formulas.insert(formulas.end(), traction->begin(), traction->end());
    if (deck.loads[i].temperature_change) formulas.push_back(deck.loads[i].temperature_change->formula);
    check(formulas, fmt::format("loads[{}]", i));
  }
  for (std::size_t i = 0; i < deck.supports.size(); ++i) {
    std::vector<deck::Formula> formulas;
    for (const auto& value : deck.supports[i].displacement)
      if (value) formulas.push_back(*value);
    if (deck.supports[i].normal) formulas.push_back(*deck.supports[i].normal);
    check(formulas, fmt::format("supports[{}]", i));
  }
}

// Local axes by their names, and what has components along them.
void check_axes(const Deck& deck, deck::Document& document)
{
  for (const auto& [name, axes] : deck.axes) {
    const auto path = "axes." + name;
    if (deck.dimension() == 3) {
      if (axes.x && !axes.y) document.error(path, "the key \"y\" is missing: The direction of the second axis");
      continue;
    }
    const auto along_z = [](const std::array<double, 3>& v) { return v[0] == 0 && v[1] == 0; };
    const auto in_plane = [](const std::array<double, 3>& v) { return v[2] == 0; };
    if (axes.axis && deck.axisymmetric())
      document.error(path + ".axis", "in an axisymmetric model x is radial and y axial; no other axes of this kind are needed");
    else if (axes.axis && !along_z(*axes.axis))
      document.error(path + ".axis", "in a plane model the axis is that of z; expected [0, 0, 1]");
    if (axes.x && !in_plane(*axes.x)) document.error(path + ".x", "a plane model has no z component");
    if (axes.y) document.error(path + ".y", "in a plane model `x` alone gives both axes");
    if (!in_plane(axes.point)) document.error(path + ".point", "a plane model has no z component");
  }
  const auto find = [&](const std::string& name, const std::string& path) -> const deck::AxesOptions* {
    if (const auto found = deck.axes.find(name); found != deck.axes.end()) return &found->second;
    document.error(path + ".axes", fmt::format("there are no axes \"{}\"{}", name, deck::suggestion(name, keys_of(deck.axes))));
    return nullptr;
  };
  for (const auto& [name, material] : deck.materials)
    if (material.orthotropic && !material.orthotropic->axes.empty())
      find(material.orthotropic->axes, "materials." + name + ".orthotropic");
  if (!deck.output.axes.empty()) find(deck.output.axes, "output");
  for (const auto& [name, probe] : deck.output.probes)
    if (!probe.axes.empty()) find(probe.axes, "output.probes." + name);
  for (std::size_t i = 0; i < deck.supports.size(); ++i) {
    const auto& support = deck.supports[i];
    const auto path = fmt::format("supports[{}]", i);
    const bool any =
        std::any_of(support.displacement.begin(), support.displacement.end(), [](const auto& v) { return v.has_value(); });
    if (support.axes.empty()) {
      if (support.cylindrical)
        document.error(path + ".displacement", "radial, tangential and axial are along cylindrical `axes`; name some");
      continue;
    }
    if (const auto* axes = find(support.axes, path); axes && any && axes->axis.has_value() != support.cylindrical)
      document.error(path + ".displacement", axes->axis ? "these axes are cylindrical; expected radial, tangential or axial"
                                                        : "these axes are turned ones; expected x, y or z");
  }
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& load = deck.loads[i];
    const auto path = fmt::format("loads[{}]", i);
    if (load.axes.empty()) continue;
    if (const auto* axes = find(load.axes, path); axes && axes->axis && load.force)
      document.error(path + ".axes", "a force has one direction; expected turned axes, or a traction");
  }
}

void check_couplings(const Deck& deck, deck::Document& document)
{
  const auto check = [&](const std::string& name, const std::string& path) {
    if (!name.empty() && !deck.couplings.contains(name))
      document.error(path, fmt::format("there is no coupling \"{}\"{}", name, deck::suggestion(name, keys_of(deck.couplings))));
  };
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    check(deck.supports[i].coupling, fmt::format("supports[{}].coupling", i));
  for (std::size_t i = 0; i < deck.loads.size(); ++i) check(deck.loads[i].coupling, fmt::format("loads[{}].coupling", i));
  const auto is_rigid = [&](const std::string& boundary) {
    return std::any_of(deck.couplings.begin(), deck.couplings.end(),
                       [&](const auto& c) { return c.second.kind == "rigid" && c.second.boundary == boundary; });
  };
  for (std::size_t i = 0; i < deck.contacts.size(); ++i)
    if (const auto& contact = deck.contacts[i]; is_rigid(contact.secondary) && (contact.obstacle || is_rigid(contact.primary)))
      document.error(
          fmt::format("contacts[{}]", i),
          "both sides are rigid, so that nothing says how the force between them is spread; make a coupling distributing");
  for (const auto& [name, coupling] : deck.couplings) {
    if (deck.axisymmetric())
      document.error("couplings." + name,
                     "couplings are not for axisymmetric models, where a `force` on the boundary is that of the whole turn");
    if (deck.dimension() == 2 && coupling.point[2] != 0)
      document.error("couplings." + name + ".point", "a plane model has no z component");
    for (std::size_t i = 0; i < deck.supports.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        if (deck.supports[i].coupling != name || deck.supports[k].coupling != name) continue;
        for (std::size_t c = 0; c < 3; ++c)
          if ((deck.supports[i].displacement[c] && deck.supports[k].displacement[c]) ||
              (deck.supports[i].rotation[c] && deck.supports[k].rotation[c]))
            document.error(
                fmt::format("supports[{}]", i),
                fmt::format("supports[{}] prescribes a component of the motion of \"{}\", too; name it once", k, name));
      }
  }
}

}  // namespace

Contacts as_written(const Deck& deck)
{
  Contacts contacts{deck.contacts, std::vector<std::size_t>(deck.contacts.size())};
  std::iota(contacts.entry.begin(), contacts.entry.end(), 0U);
  return contacts;
}

void check_contacts(const Contacts& contacts, fem::Kinematics kinematics, deck::Document& document)
{
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto& contact = contacts[i];
    if (contact.obstacle) {
      if (const auto why = contact::misfit(*contact.obstacle, kinematics); !why.empty())
        document.error(contacts.path(i) + ".primary", why);
      continue;
    }
    if (contact.cyclic)
      if (const auto why = contact::misfit(*contact.cyclic, kinematics); !why.empty())
        document.error(contacts.path(i) + ".cyclic", why);
    const auto secondary = parse_boundary(contact.secondary), primary = parse_boundary(contact.primary);
    if (contact.secondary != contact.primary && secondary.boundary == primary.boundary &&
        (secondary.body == primary.body || secondary.body.empty() || primary.body.empty()))
      document.error(contacts.path(i),
                     fmt::format("\"{}\" and \"{}\" have faces in common; narrow both to different bodies (body:boundary)",
                                 contact.secondary, contact.primary));
  }
  std::map<std::string, std::size_t> first;  // contact of a name
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto& contact = contacts[i];
    const auto [at, fresh] = first.emplace(contact.name, i);
    if (!fresh && !(contact.automatic && contacts[at->second].automatic))
      document.error(contacts.path(i),
                     fmt::format("two contacts are called \"{}\"; give one of them another `name`", contact.name));
  }
}

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

}  // namespace

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
    for (const auto& name : part.unavailable()) d.unavailable(name);
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
  check_vectors(deck, document);
  check_couplings(deck, document);
  check_axes(deck, document);
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

void check_names(const Deck& deck, const Contacts& contacts, deck::Document& document, const mesh::Catalogue& catalogue)
{
  std::vector<std::string> groups;
  for (const auto& body : catalogue.bodies)
    if (std::find(groups.begin(), groups.end(), body.group) == groups.end()) groups.push_back(body.group);
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
    if (load.body.empty() || !load.points.empty()) continue;
    const auto at = fmt::format("loads[{}].body", i);
    const bool known = std::any_of(catalogue.bodies.begin(), catalogue.bodies.end(),
                                   [&](const mesh::Body& b) { return matches_name(b, load.body); });
    if (!known) document.error(at, fmt::format("the mesh has no body \"{}\"{}", load.body, deck::suggestion(load.body, groups)));
    for (const auto& body : catalogue.bodies) {
      if (!matches_name(body, load.body)) continue;
      const auto entry = body_entry(deck, body.group);
      if (entry == deck.bodies.end()) continue;
      const auto of_body = [&](const auto& material) { return is_made_of(entry->second, material.first); };
      const auto light = std::find_if(deck.materials.begin(), deck.materials.end(),
                                      [&](const auto& material) { return of_body(material) && !(material.second.density > 0); });
      if (load.centrifugal && entry->second.method == fem::Method::boundary_elements) {
        document.error(
            at, fmt::format("centrifugal loads are for finite elements, and the body \"{}\" is of boundary elements", body.name));
        break;
      }
      if (load.temperature_change && !load.temperature_change->is_constant() &&
          entry->second.method == fem::Method::boundary_elements) {
        document.error(at, fmt::format("a temperature that varies is for finite elements, and the body \"{}\" is of boundary "
                                       "elements, which take a number",
                                       body.name));
        break;
      }
      if ((load.acceleration || load.centrifugal) && light != deck.materials.end()) {
        document.error(at, fmt::format("an acceleration needs a density > 0 of the material \"{}\"", light->first));
        break;
      }
      const auto any = std::find_if(deck.materials.begin(), deck.materials.end(), of_body);
      const bool expands = std::any_of(deck.materials.begin(), deck.materials.end(),
                                       [&](const auto& material) { return of_body(material) && material.second.expands(); });
      if (load.temperature_change && any != deck.materials.end() && !expands) {
        document.error(at, fmt::format("a temperature_change needs a thermal_expansion (strain a degree) of the material \"{}\"",
                                       any->first));
        break;
      }
    }
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].automatic) continue;
    check(contacts[i].secondary, contacts.path(i) + ".secondary");
    if (!contacts[i].obstacle) check(contacts[i].primary, contacts.path(i) + ".primary");
  }
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
