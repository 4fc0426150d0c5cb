#include "constraint/options.hpp"

#include <algorithm>

#include "deck/cases.hpp"

namespace mortise::constraint {

namespace {

using Angles = deck::Codec<std::array<std::optional<double>, 3>>;

const std::array<std::string, 3> of_model{"x", "y", "z"}, of_cylinder{"radial", "tangential", "axial"};

// displacement: {x: 0, y: "0.1 * z"} | {radial: 0} | {normal: 0}, and x, y, z or radial, tangential, axial beside normal
void read_displacement(SupportOptions& support, const YAML::Node& node, const std::string& path, deck::Document& document,
                       const deck::Limits& limits)
{
  if (!node.IsMap() || node.size() == 0) {
    document.error(path, "expected components such as {x: 0, y: 0}, found " + deck::found(node));
    return;
  }
  bool cartesian = false;
  for (const auto& entry : node) {
    const auto name = entry.first.Scalar();
    const auto at = path + "." + name;
    document.locate(at, entry.first);
    const auto x = static_cast<std::size_t>(std::find(of_model.begin(), of_model.end(), name) - of_model.begin());
    const auto r = static_cast<std::size_t>(std::find(of_cylinder.begin(), of_cylinder.end(), name) - of_cylinder.begin());
    cartesian = cartesian || x < 3;
    support.cylindrical = support.cylindrical || r < 3;
    auto* value = name == "normal" ? &support.normal
                  : x < 3          ? &support.displacement[x]
                  : r < 3          ? &support.displacement[r]
                                   : nullptr;
    if (!value)
      document.error(at, "unknown component, expected x, y, z or normal; with cylindrical `axes` radial, tangential or axial");
    else if (*value)
      document.error(at, "is given twice");
    else
      deck::Codec<deck::Formula>::read(value->emplace(), entry.second, at, document, limits);
  }
  if (cartesian && support.cylindrical) document.error(path, "expected components of one kind of axes, found two");
}

bool any(const auto& components)
{
  return std::any_of(components.begin(), components.end(), [](const auto& c) { return c.has_value(); });
}

YAML::Node write_displacement(const SupportOptions& support)
{
  YAML::Node node;
  const auto& names = support.cylindrical ? of_cylinder : of_model;
  for (std::size_t c = 0; c < 3; ++c)
    if (support.displacement[c]) node[names[c]] = deck::Codec<deck::Formula>::write(*support.displacement[c]);
  if (support.normal) node["normal"] = deck::Codec<deck::Formula>::write(*support.normal);
  if (node.size() > 0) node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

// stiffness: {normal: 10, tangential: 2} | {x: 10, z: 5}
void read_stiffness(SupportOptions& support, const YAML::Node& node, const std::string& path, deck::Document& document,
                    const deck::Limits& limits)
{
  if (!node.IsMap() || node.size() == 0) {
    document.error(path,
                   "expected {normal: .., tangential: ..}, or components such as {x: 10, z: 5}, found " + deck::found(node));
    return;
  }
  auto& stiffness = support.stiffness;
  for (const auto& entry : node) {
    const auto name = entry.first.Scalar();
    const auto at = path + "." + name;
    document.locate(at, entry.first);
    const auto x = static_cast<std::size_t>(std::find(of_model.begin(), of_model.end(), name) - of_model.begin());
    auto* value = name == "normal"       ? &stiffness.normal
                  : name == "tangential" ? &stiffness.tangential
                  : x < 3                ? &stiffness.along[x]
                                         : nullptr;
    if (!value)
      document.error(at, "unknown component, expected normal and tangential, or x, y, z");
    else if (*value)
      document.error(at, "is given twice");
    else
      deck::Codec<double>::read(value->emplace(), entry.second, at, document, limits);
  }
  if ((stiffness.normal || stiffness.tangential) && any(stiffness.along))
    document.error(path, "expected normal and tangential, or x, y, z, found both");
  else if (stiffness.tangential && !stiffness.normal)
    document.error(path + ".tangential", "a tangential stiffness needs a normal one beside it");
}

YAML::Node write_stiffness(const SupportOptions& support)
{
  YAML::Node node;
  const auto& stiffness = support.stiffness;
  for (std::size_t c = 0; c < 3; ++c)
    if (stiffness.along[c]) node[of_model[c]] = deck::Codec<double>::write(*stiffness.along[c]);
  if (stiffness.normal) node["normal"] = deck::Codec<double>::write(*stiffness.normal);
  if (stiffness.tangential) node["tangential"] = deck::Codec<double>::write(*stiffness.tangential);
  if (node.size() > 0) node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

nlohmann::ordered_json stiffness_schema(const deck::Limits& limits)
{
  const auto value = deck::Codec<double>::schema(limits);
  nlohmann::ordered_json schema{{"type", "object"}, {"properties", nlohmann::ordered_json::object()}};
  for (const char* name : {"normal", "tangential", "x", "y", "z"}) schema["properties"][name] = value;
  schema["additionalProperties"] = false;
  schema["minProperties"] = 1;
  schema["allOf"].push_back(deck::when(deck::any_given({"normal", "tangential"}), deck::none_given({"x", "y", "z"})));
  schema["allOf"].push_back(deck::when(deck::given({"tangential"}), deck::given({"normal"})));
  return schema;
}

nlohmann::ordered_json displacement_schema(const deck::Limits& limits)
{
  const auto value = deck::Codec<deck::Formula>::schema(limits);
  nlohmann::ordered_json schema{{"type", "object"}, {"properties", nlohmann::ordered_json::object()}};
  for (const auto* names : {&of_model, &of_cylinder})
    for (const auto& name : *names) schema["properties"][name] = value;
  schema["properties"]["normal"] = value;
  schema["additionalProperties"] = false;
  schema["minProperties"] = 1;
  schema["allOf"].push_back(deck::when(deck::any_given({"radial", "tangential", "axial"}), deck::none_given({"x", "y", "z"})));
  return schema;
}

// The rules of the check below for the schema.
nlohmann::ordered_json support_rules()
{
  using namespace deck;
  const auto no_normal = key_fits("displacement", none_given({"normal"}));
  const auto of_coupling =
      all_of({any_given({"displacement", "rotation"}), none_given({"stiffness", "axes", "body"}), no_normal});
  const auto of_points =
      when(given({"points"}), all_of({no_normal, key_fits("stiffness", none_given({"normal", "tangential"}))}));
  const auto of_nodes = all_of({one_given({"displacement", "stiffness"}), none_given({"rotation"}),
                                when(given({"stiffness"}), none_given({"axes"})), of_points});
  return all_of({one_given({"boundary", "coupling", "points"}), when(given({"body"}), given({"points"})),
                 schema_by_case(given({"coupling"}), of_coupling, of_nodes)});
}

}  // namespace

void describe(deck::Description<SupportOptions>& d)
{
  d.help("Prescribed displacements of a boundary.");
  d.key("boundary", &SupportOptions::boundary, "Boundary whose displacement is prescribed.");
  d.key("coupling", &SupportOptions::coupling, "Instead of a boundary: the coupling whose point is prescribed.");
  d.key("name", &SupportOptions::name, "To refer to it; the boundary or coupling if not given.");
  d.key("points", &SupportOptions::points,
        "Instead of a boundary: nodes of the surface, by their coordinates or by the name of a curve or a point of the mesh.");
  d.key("body", &SupportOptions::body, "Of `points`: whose nodes are meant, where several bodies have some there.");
  d.key("axes", &SupportOptions::axes, "Local axes, by their name in the section `axes`, for the components.");
  d.custom("displacement",
           "Components by axis, and `normal`: along the boundary's own outward normal, node by node, as for planes of symmetry "
           "and the cuts of a sector at an angle. Numbers, or formulas in x, y, z, r, theta, t. One that is not named is free.",
           read_displacement, write_displacement, displacement_schema);
  d.custom("stiffness",
           "Instead of `displacement`: springs to the ground. Of a boundary: an elastic foundation, force a length and area, by "
           "{normal: .., tangential: ..} or by axis; of `points`: force a length of each, by axis. They push and pull.",
           read_stiffness, write_stiffness, stiffness_schema)
      .positive();
  d.custom(
      "rotation", "Of a coupling: small angles in radians about the axes through its point. One that is not named is free.",
      [](SupportOptions& support, const YAML::Node& node, const std::string& path, deck::Document& document,
         const deck::Limits& limits) { Angles::read(support.rotation, node, path, document, limits); },
      [](const SupportOptions& support) { return any(support.rotation) ? Angles::write(support.rotation) : YAML::Node(); },
      [](const deck::Limits& limits) { return Angles::schema(limits); });
  d.rule(support_rules());
  d.check([](const SupportOptions& support, const std::string& path, deck::Document& document) {
    const int places = !support.boundary.empty() + !support.coupling.empty() + !support.points.empty();
    if (places == 0) document.error(path, "the key \"boundary\" is missing: Boundary whose displacement is prescribed.");
    if (places > 1) document.error(path, "expected one of `boundary`, `coupling` and `points`, found several");
    if (!support.body.empty() && support.points.empty())
      document.error(path + ".body", "a body is named for `points`; a boundary is narrowed as \"body:boundary\"");
    if (support.coupling.empty()) {
      if (any(support.rotation)) document.error(path + ".rotation", "a boundary has no rotation; couple it to a point first");
      if (support.stiffness.any()) {
        if (any(support.displacement) || support.normal)
          document.error(path + ".stiffness", "a support has a `displacement` or a `stiffness`; write two supports");
        if (!support.points.empty() && support.stiffness.normal)
          document.error(path + ".stiffness", "a point has no normal; name components by axis");
        if (!support.axes.empty()) document.error(path + ".axes", "a stiffness acts along the axes of the model, or normals");
        return;
      }
      if (!any(support.displacement) && !support.normal)
        document.error(path, "the key \"displacement\" is missing: Components by axis, and `normal`");
      if (support.normal && !support.points.empty())
        document.error(path + ".displacement.normal", "a point has no normal; name components by axis");
      return;
    }
    if (support.normal) document.error(path + ".displacement.normal", "a point has no normal; name components by axis");
    if (support.stiffness.any())
      document.error(path + ".stiffness", "springs hold boundaries and points; give the coupled boundary a stiffness");
    if (!support.axes.empty()) document.error(path + ".axes", "a coupling's point moves along the axes of the model");
    for (const auto& value : support.displacement)
      if (value && !value->is_constant())
        document.error(path + ".displacement", "a coupling's point has one displacement; expected numbers, scaled by load steps");
    if (!any(support.displacement) && !any(support.rotation))
      document.error(path, "expected a `displacement` or a `rotation` of the coupling's point");
  });
}

}  // namespace mortise::constraint
