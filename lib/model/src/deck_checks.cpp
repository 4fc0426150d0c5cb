#include "deck_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "contact/cyclic.hpp"
#include "model/model.hpp"

namespace mortise::model {

namespace {

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

void check_materials_of_bodies(const Deck& deck, deck::Document& document)
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
}

void check_formulations(const Deck& deck, deck::Document& document)
{
  for (const auto& [name, body] : deck.bodies)
    if (body.formulation == fem::Formulation::bbar && deck.kinematics == fem::Kinematics::plane_stress)
      document.error("bodies." + name + ".formulation",
                     "nothing locks in plane stress, where the thickness is free; expected standard");
  for (const auto& [name, body] : deck.bodies)
    if (body.formulation == fem::Formulation::incompatible && deck.axisymmetric())
      document.error("bodies." + name + ".formulation",
                     "the incompatible modes are for boxes, not for rings; expected standard or bbar, or cells of second order");
}

void check_orthotropic_bodies(const Deck& deck, deck::Document& document)
{
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
  }
}

void check_cells_of_blocks(const Deck& deck, deck::Document& document)
{
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

void check_directions_of_axes(const Deck& deck, deck::Document& document)
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
}

// Local axes by their names, and what has components along them.
void check_uses_of_axes(const Deck& deck, deck::Document& document)
{
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
                                                        : "these axes are rotated ones; expected x, y or z");
  }
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& load = deck.loads[i];
    const auto path = fmt::format("loads[{}]", i);
    if (load.axes.empty()) continue;
    if (const auto* axes = find(load.axes, path); axes && axes->axis && (load.force || load.moment))
      document.error(path + ".axes", load.force ? "a force has one direction; expected rotated axes, or a traction"
                                                : "a moment has one direction; expected rotated axes");
  }
}

void check_uses_of_couplings(const Deck& deck, deck::Document& document)
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
}

}  // namespace

void check_bodies(const Deck& deck, deck::Document& document)
{
  check_materials_of_bodies(deck, document);
  check_formulations(deck, document);
  check_orthotropic_bodies(deck, document);
  for (const auto& [name, body] : deck.bodies)
    if (body.method == fem::Method::boundary_elements) check_boundary_elements(deck, name, body, document);
  check_cells_of_blocks(deck, document);
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

void check_solver(const Deck& deck, deck::Document& document)
{
  constexpr double least = 1e-4;
  const auto& [programme, subdomains] = deck.solver;
  if (subdomains.factor_precision == "single" && programme.tolerance.value && *programme.tolerance.value < least)
    document.error(
        "solver.factor_precision",
        "single precision is not exact enough for this tolerance; expected auto or at least 1e-4 for it, or double here");
}

void check_axes(const Deck& deck, deck::Document& document)
{
  check_directions_of_axes(deck, document);
  check_uses_of_axes(deck, document);
}

void check_couplings(const Deck& deck, deck::Document& document)
{
  check_uses_of_couplings(deck, document);
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

}  // namespace mortise::model
