#include "fem/options.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "deck/cases.hpp"

namespace mortise::fem {

namespace {

const std::map<std::string, Formulation>& formulations()
{
  static const std::map<std::string, Formulation> table{
      {"standard", Formulation::standard}, {"bbar", Formulation::bbar}, {"incompatible", Formulation::incompatible}};
  return table;
}

const std::map<std::string, Method>& methods()
{
  static const std::map<std::string, Method> table{{"finite_elements", Method::finite_elements},
                                                   {"boundary_elements", Method::boundary_elements}};
  return table;
}

// A key whose values are the names of an enumeration.
template <class E>
auto& names_key(deck::Description<BodyOptions>& d, const std::string& key, const std::string& help, E BodyOptions::*member,
                const std::map<std::string, E>& (*table)())
{
  return d.custom(
      key, help,
      [member, table](BodyOptions& body, const YAML::Node& node, const std::string& path, deck::Document& document,
                      const deck::Limits& limits) {
        std::string name;
        deck::Codec<std::string>::read(name, node, path, document, limits);
        const auto found = table().find(name);
        if (found != table().end()) body.*member = found->second;
      },
      [member, table](const BodyOptions& body) {
        for (const auto& [name, value] : table())
          if (value == body.*member) return YAML::Node(name);
        return YAML::Node();
      },
      [](const deck::Limits& limits) { return deck::Codec<std::string>::schema(limits); });
}

void read_temperature(LoadOptions& load, const YAML::Node& node, const std::string& path, deck::Document& document,
                      const deck::Limits& limits)
{
  auto& change = load.temperature_change.emplace();
  if (node.IsMap())
    deck::Codec<TemperatureFile>::read(change.file.emplace(), node, path, document, limits);
  else
    deck::Codec<deck::Formula>::read(change.formula, node, path, document, limits);
}

YAML::Node write_temperature(const LoadOptions& load)
{
  if (!load.temperature_change) return YAML::Node();
  const auto& change = *load.temperature_change;
  return change.file ? deck::Codec<TemperatureFile>::write(*change.file) : deck::Codec<deck::Formula>::write(change.formula);
}

}  // namespace

int dimension(Kinematics kinematics)
{
  return kinematics == Kinematics::solid ? 3 : 2;
}

double thickness(Kinematics kinematics, double x)
{
  return kinematics == Kinematics::axisymmetric ? 2 * std::numbers::pi * x : 1;
}

bool applies(Formulation formulation, mesh::CellType type)
{
  using enum mesh::CellType;
  if (formulation == Formulation::standard) return true;
  return type == hex8 || type == quad4 || (type == prism6 && formulation == Formulation::bbar);
}

Eigen::Matrix3d flexibility(const Orthotropy& m)
{
  const auto& [e1, e2, e3] = m.young_modulus;
  const auto& [nu12, nu13, nu23] = m.poisson_ratio;
  return (Eigen::Matrix3d() << 1 / e1, -nu12 / e1, -nu13 / e1, -nu12 / e1, 1 / e2, -nu23 / e2, -nu13 / e1, -nu23 / e2, 1 / e3)
      .finished();
}

double Material::modulus() const
{
  return orthotropic ? *std::min_element(orthotropic->young_modulus.begin(), orthotropic->young_modulus.end()) : young_modulus;
}

namespace {

// Whether every strain takes energy; if not, what is wrong.
std::string instability(const Orthotropy& m)
{
  const std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  const std::array<const char*, 3> names{"12", "13", "23"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [i, j] = pairs[k];
    const double limit = std::sqrt(m.young_modulus[i] / m.young_modulus[j]);
    if (!(std::abs(m.poisson_ratio[k]) < limit))
      return fmt::format("poisson_ratio {} is {:.6g}; expected less than the root of E{} / E{}, {:.6g}", names[k],
                         m.poisson_ratio[k], i + 1, j + 1, limit);
  }
  const auto& e = m.young_modulus;
  const Eigen::Vector3d root(std::sqrt(e[0]), std::sqrt(e[1]), std::sqrt(e[2]));
  const Eigen::Matrix3d scaled = root.asDiagonal() * flexibility(m) * root.asDiagonal();
  if (scaled.determinant() < 1e-9)
    return "the three poisson_ratio together make a material that some stress does not resist; expected smaller ones";
  return "";
}

// A constant of isotropic materials alone: in decks that are written back it stands only there.
auto& isotropic_key(deck::Description<Material>& d, const char* name, double Material::*member, const char* help)
{
  return d.custom(
      name, help,
      [member](Material& material, const YAML::Node& node, const std::string& path, deck::Document& document,
               const deck::Limits& limits) { deck::Codec<double>::read(material.*member, node, path, document, limits); },
      [member](const Material& material) {
        return material.young_modulus > 0 ? deck::Codec<double>::write(material.*member) : YAML::Node();
      },
      [](const deck::Limits& limits) { return deck::Codec<double>::schema(limits); });
}

// The rules of check_load for the schema.
nlohmann::ordered_json load_rules()
{
  using namespace deck;
  const KeyNames on_bodies{"acceleration", "centrifugal", "temperature_change"};
  const KeyNames kinds{"pressure", "traction", "force", "acceleration", "centrifugal", "temperature_change"};
  const auto of_coupling = all_of(
      {any_given({"force", "moment"}),
       none_given({"boundary", "body", "points", "pressure", "traction", "acceleration", "centrifugal", "temperature_change"})});
  const auto of_points = all_of({given({"force"}), none_given({"boundary"})});
  const auto of_boundary = all_of({given({"boundary"}), none_given({"body"}), when(given({"pressure"}), none_given({"axes"}))});
  const auto place = schema_by_case(any_given(on_bodies), all_of({given({"body"}), none_given({"boundary", "points", "axes"})}),
                                    schema_by_case(given({"points"}), of_points, of_boundary));
  return schema_by_case(given({"coupling"}), of_coupling, all_of({one_given(kinds), none_given({"moment"}), place}));
}

// What goes together, and on what it acts.
void check_load(const LoadOptions& load, const std::string& path, deck::Document& document)
{
  if (!load.coupling.empty()) {
    if (!load.boundary.empty() || !load.body.empty() || !load.points.empty())
      document.error(path, "expected one of `coupling`, `boundary`, `points` and `body`");
    if (!load.force && !load.moment) document.error(path, "a coupling takes a `force`, a `moment`, or both");
    if (load.pressure || load.traction || load.acceleration || load.centrifugal || load.temperature_change)
      document.error(path, "a coupling takes a `force` and a `moment` alone");
    return;
  }
  if (load.moment) document.error(path + ".moment", "a moment acts on a `coupling`; couple the boundary to a point first");
  const bool on_body = load.acceleration || load.centrifugal || load.temperature_change;
  const int given = load.pressure.has_value() + load.traction.has_value() + load.force.has_value() +
                    load.acceleration.has_value() + load.centrifugal.has_value() + load.temperature_change.has_value();
  if (given != 1)
    document.error(
        path, fmt::format(
                  "expected exactly one of pressure, traction, force, acceleration, centrifugal and temperature_change, found {}",
                  given));
  if (!load.axes.empty() && !load.traction && !load.force)
    document.error(path + ".axes", "local axes are for a traction or a force");
  if (!load.points.empty()) {
    if (!load.force) document.error(path, "points take a `force`");
    if (!load.boundary.empty()) document.error(path, "expected either `boundary` or `points`, found both");
    return;
  }
  if (load.boundary.empty() != on_body || load.body.empty() == on_body)
    document.error(path, !on_body            ? "this load acts on a `boundary`"
                         : load.acceleration ? "an acceleration acts on a `body`"
                         : load.centrifugal  ? "a centrifugal load acts on a `body`"
                                             : "a change of temperature acts on a `body`");
}

}  // namespace

void describe(deck::Description<Orthotropy>& d)
{
  d.help("Elasticity along three directions 1, 2, 3: Abaqus' engineering constants.");
  d.key("young_modulus", &Orthotropy::young_modulus, "E1, E2, E3.").required().positive();
  d.key("poisson_ratio", &Orthotropy::poisson_ratio,
        "nu12, nu13, nu23: a stress along 1 strains 2 by -nu12 / E1 of it; nu21 = nu12 E2 / E1, and so on.")
      .required();
  d.key("shear_modulus", &Orthotropy::shear_modulus, "G12, G13, G23.").required().positive();
  d.key("thermal_expansion", &Orthotropy::thermal_expansion,
        "Strains a degree along 1, 2, 3; default: that of the material in all.");
  d.key(
      "axes", &Orthotropy::axes,
      "The directions, by their name in the section `axes`: 1, 2, 3 are x, y, z or radial, tangential, axial; default: the axes "
      "of the model. They are those of the part, and move with its `instances`. In plane models 3 is across the plane, in "
      "axisymmetric ones along the hoop.");
  d.check([](const Orthotropy& m, const std::string& path, deck::Document& document) {
    for (const auto& [constants, name] : {std::pair(m.young_modulus, ".young_modulus"), {m.shear_modulus, ".shear_modulus"}})
      if (!(constants[2] > 0)) return document.error(path + name, "expected three entries, in plane models too");
    if (const auto why = instability(m); !why.empty()) document.error(path, why);
  });
}

void describe(deck::Description<Material>& d)
{
  d.help("Linear elasticity, in any consistent units: isotropic, by `young_modulus` and `poisson_ratio`, or `orthotropic`.");
  isotropic_key(d, "young_modulus", &Material::young_modulus, "Young's modulus.").positive();
  isotropic_key(d, "poisson_ratio", &Material::poisson_ratio, "Poisson's ratio.").above(-1).below(0.5);
  d.key("orthotropic", &Material::orthotropic, "Instead of these two: constants along three directions.");
  d.key("density", &Material::density, "Mass a volume, for accelerations.").at_least(0);
  d.key("thermal_expansion", &Material::thermal_expansion, "Strain a degree, for changes of temperature.");
  d.rule(deck::schema_by_case(deck::given({"orthotropic"}), deck::none_given({"young_modulus", "poisson_ratio"}),
                              deck::given({"young_modulus", "poisson_ratio"})));
  d.check_keys([](const std::vector<std::string>& given, const std::string& path, deck::Document& document) {
    const auto has = [&](const char* key) { return std::find(given.begin(), given.end(), key) != given.end(); };
    for (const char* key : {"young_modulus", "poisson_ratio"}) {
      if (has("orthotropic") && has(key))
        document.error(path + "." + key,
                       "the material is `orthotropic`, which says it along three directions; leave one of them out");
      if (!has("orthotropic") && !has(key))
        document.error(
            path, fmt::format("the key \"{}\" is missing: {}", key, key[0] == 'y' ? "Young's modulus." : "Poisson's ratio."));
    }
  });
}

void describe(deck::Description<BodyOptions>& d)
{
  d.help("What a body is made of, and how it is discretised.");
  d.key("material", &BodyOptions::material, "Name of a material; absent where `volumes` is given.");
  d.key("volumes", &BodyOptions::volumes,
        "Physical volumes (plane models: surfaces) of the file that form this one body, each with its material: {core: rubber, "
        "skin: steel}. They must share the nodes of the faces in which they meet.");
  d.custom(
      "instances",
      "Copies of the body: a list of motions, {translate, rotate: {axis, angle, center}}, rotate first, then translate; with "
      "`count` a row of copies, each moved once more than the one before. The list says where all copies are: the body as it "
      "lies "
      "in the mesh is none of them unless a motion leaves it there. Copy i of \"roller\" is the body roller.i with boundaries "
      "roller.i.NAME, of a boundary roller.NAME or roller_NAME as well; NAME alone means those of all copies.",
      [](BodyOptions& body, const YAML::Node& node, const std::string& path, deck::Document& document,
         const deck::Limits& limits) {
        const auto before = document.error_count();
        deck::Codec<std::vector<mesh::InstanceOptions>>::read(body.instances, node, path, document, limits);
        if (document.error_count() == before && body.instances.empty())
          document.error(path, "expected at least one instance; without this key the body is where it lies in the mesh");
      },
      [](const BodyOptions& body) {
        return body.instances.empty() ? YAML::Node() : deck::Codec<std::vector<mesh::InstanceOptions>>::write(body.instances);
      },
      [](const deck::Limits& limits) { return deck::Codec<std::vector<mesh::InstanceOptions>>::schema(limits); });
  names_key(d, "method",
            "finite_elements: in the cells of the body; boundary_elements: on its surface alone, by flat triangles, in plane "
            "models by straight lines (not axisymmetric; bodies of one material).",
            &BodyOptions::method, methods)
      .one_of({"finite_elements", "boundary_elements"});
  d.key("surfaces", &BodyOptions::surfaces,
        "For boundary_elements, where the file has no cells of the body but its closed surface: the physical surfaces (plane "
        "models: curves) that enclose it together, with those of its cavities; without this key the one of the body's name.");
  names_key(
      d, "formulation",
      "standard: full integration; bbar: nearly incompressible materials (hex8, quad4, prism6); incompatible: bending (hex8, "
      "quad4).",
      &BodyOptions::formulation, formulations)
      .one_of({"standard", "bbar", "incompatible"});
  d.rule(deck::one_given({"material", "volumes"}));
  d.rule(
      deck::schema_by_case(deck::given_as("method", {{"const", "boundary_elements"}}),
                           deck::all_of({deck::none_given({"volumes"}), deck::key_fits("formulation", {{"const", "standard"}})}),
                           deck::none_given({"surfaces"})));
  d.check([](const BodyOptions& body, const std::string& path, deck::Document& document) {
    if (body.material.empty() == body.volumes.empty())
      document.error(path, body.volumes.empty() ? "the key \"material\" is missing: Name of a material."
                                                : "expected either `material` or `volumes`, found both");
    if (body.method != Method::boundary_elements) {
      if (!body.surfaces.empty())
        document.error(deck::join(path, "surfaces"),
                       "finite elements need the cells of the body; remove this, or take `method: boundary_elements`");
      return;
    }
    if (!body.volumes.empty())
      document.error(deck::join(path, "volumes"),
                     "boundary elements are for bodies of one material; give the body a `material`, or take finite_elements");
    if (body.formulation != Formulation::standard)
      document.error(deck::join(path, "formulation"),
                     "this is a formulation of finite elements; remove it, or take `method: finite_elements`");
  });
}

void describe(deck::Description<Centrifugal>& d)
{
  d.help("A body that turns about an axis: what it feels of its mass.");
  d.key("axis", &Centrifugal::axis, "Direction of the axis: [0, 0, 1] in planes, [0, 1, 0] in axisymmetric models.").required();
  d.key("point", &Centrifugal::point, "A point of the axis; the origin if not given.");
  d.key("speed", &Centrifugal::speed, "Angle a unit of time, in radians: 2 pi times the turns.").required();
  d.check([](const Centrifugal& load, const std::string& path, deck::Document& document) {
    if (!(std::hypot(load.axis[0], load.axis[1], load.axis[2]) > 0))
      document.error(deck::join(path, "axis"), "expected a direction, found a vector without length");
  });
}

Point centrifugal_acceleration(const Centrifugal& load, const Point& x)
{
  const Point axis = Point(load.axis[0], load.axis[1], load.axis[2]).normalized();
  const Point arm = x - Point(load.point[0], load.point[1], load.point[2]);
  return load.speed * load.speed * (arm - axis * axis.dot(arm));
}

void describe(deck::Description<TemperatureFile>& d)
{
  d.help("Temperatures from a file, interpolated: those of a heat analysis on another mesh, or of points.");
  d.key("file", &TemperatureFile::file,
        "A .vtu file with a field of points, or a .csv file with a line of names, x, y, z (plane models: x, y) among them; "
        "relative to the deck, in the deck's unit of length.")
      .required();
  d.key("field", &TemperatureFile::field, "Its field or column; default: the only one, or `temperature`.");
  d.key("reference", &TemperatureFile::reference, "The temperature at which the body has no stress.");
}

void describe(deck::Description<LoadOptions>& d)
{
  d.help(
      "One load: pressure, traction or force on a boundary; acceleration, turning or temperature change of a body; force and "
      "moment at "
      "the "
      "point of a coupling.");
  d.key("name", &LoadOptions::name, "To refer to it; the boundary, body or coupling if not given.");
  d.key("coupling", &LoadOptions::coupling, "Coupling whose point is loaded.");
  d.key("boundary", &LoadOptions::boundary, "Boundary that is loaded.");
  d.key("points", &LoadOptions::points,
        "Instead of a boundary: nodes of the surface that share the `force`, by their coordinates or by the name of a curve or a "
        "point of the mesh; those of a curve by its length.");
  d.key("axes", &LoadOptions::axes, "Local axes, by their name in the section `axes`, of a traction, a force or a moment.");
  d.key("body", &LoadOptions::body, "Body that is accelerated, turns or is heated.");
  d.key("pressure", &LoadOptions::pressure,
        "Force an area, positive into the body: a number, or a formula in x, y, z, r, theta, t.");
  d.key("traction", &LoadOptions::traction, "Force an area, as a vector of numbers or formulas.");
  d.key("force", &LoadOptions::force,
        "Resultant, spread evenly over the boundary (plane models: a thickness; axisymmetric: of the whole turn).");
  d.key("moment", &LoadOptions::moment, "Of a coupling: about its point, as a vector (plane models: [0, 0, m], a thickness).");
  d.key("acceleration", &LoadOptions::acceleration, "Body force is density times this.");
  d.key("centrifugal", &LoadOptions::centrifugal, "Of a body: it turns about an axis, {axis, speed, point}.");
  d.custom(
      "temperature_change",
      "Degrees that the body is warmer than when it had no stress: a number, a formula in x, y, z, r, theta, t, or a file with "
      "temperatures of nodes; its material has a thermal_expansion. Several on one body add.",
      read_temperature, write_temperature, [](const deck::Limits& limits) {
        return deck::schema_by_case({{"type", "object"}}, deck::Codec<TemperatureFile>::schema(limits),
                                    deck::Codec<deck::Formula>::schema(limits));
      });
  d.check(check_load);
  d.rule(load_rules());
}

}  // namespace mortise::fem
