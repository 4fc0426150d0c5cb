#include "constraint/options.hpp"

#include <algorithm>

namespace mortise::constraint {

namespace {

using Components = deck::Codec<std::array<std::optional<double>, 3>>;

// displacement: {x: 0, y: 0} | {normal: 0} | both
void read_displacement(SupportOptions& support, const YAML::Node& node, const std::string& path, deck::Document& document,
                       const deck::Limits& limits)
{
  if (!node.IsMap() || !node["normal"]) return Components::read(support.displacement, node, path, document, limits);
  YAML::Node components(YAML::NodeType::Map);
  for (const auto& entry : node) {
    const auto name = entry.first.Scalar();
    if (name != "normal") {
      components.force_insert(entry.first, entry.second);
      continue;
    }
    document.locate(path + ".normal", entry.first);
    if (support.normal) document.error(path + ".normal", "is given twice");
    deck::Codec<double>::read(support.normal.emplace(), entry.second, path + ".normal", document, limits);
  }
  if (components.size() > 0) Components::read(support.displacement, components, path, document, limits);
}

bool any(const std::array<std::optional<double>, 3>& components)
{
  return std::any_of(components.begin(), components.end(), [](const auto& c) { return c.has_value(); });
}

YAML::Node write_displacement(const SupportOptions& support)
{
  YAML::Node node;
  if (any(support.displacement)) node = Components::write(support.displacement);
  if (support.normal) node["normal"] = deck::Codec<double>::write(*support.normal);
  return node;
}

nlohmann::ordered_json displacement_schema(const deck::Limits& limits)
{
  auto schema = Components::schema(limits);
  schema["properties"]["normal"] = deck::Codec<double>::schema(limits);
  return schema;
}

}  // namespace

void describe(deck::Description<SupportOptions>& d)
{
  d.help("Prescribed displacements of a boundary.");
  d.key("boundary", &SupportOptions::boundary, "Boundary that is held.");
  d.key("coupling", &SupportOptions::coupling, "Instead of a boundary: the coupling whose point is held.");
  d.key("name", &SupportOptions::name, "To refer to it; the boundary or coupling if not given.");
  d.custom("displacement",
           "Components by axis, and `normal`: along the boundary's own outward normal, node by node, as for planes of symmetry "
           "and the "
           "cuts of a sector at an angle. One that is not named is free.",
           read_displacement, write_displacement, displacement_schema);
  d.custom(
      "rotation", "Of a coupling: small angles in radians about the axes through its point. One that is not named is free.",
      [](SupportOptions& support, const YAML::Node& node, const std::string& path, deck::Document& document,
         const deck::Limits& limits) { Components::read(support.rotation, node, path, document, limits); },
      [](const SupportOptions& support) { return any(support.rotation) ? Components::write(support.rotation) : YAML::Node(); },
      [](const deck::Limits& limits) { return Components::schema(limits); });
  d.check([](const SupportOptions& support, const std::string& path, deck::Document& document) {
    if (support.boundary.empty() == support.coupling.empty())
      document.error(path, support.boundary.empty() ? "the key \"boundary\" is missing: Boundary that is held."
                                                    : "expected either `boundary` or `coupling`, found both");
    if (support.coupling.empty()) {
      if (any(support.rotation)) document.error(path + ".rotation", "a boundary has no rotation; couple it to a point first");
      if (!any(support.displacement) && !support.normal)
        document.error(path, "the key \"displacement\" is missing: Components by axis, and `normal`");
    } else {
      if (support.normal) document.error(path + ".displacement.normal", "a point has no normal; name components by axis");
      if (!any(support.displacement) && !any(support.rotation))
        document.error(path, "expected a `displacement` or a `rotation` of the coupling's point");
    }
  });
}

}  // namespace mortise::constraint
