#include "constraint/options.hpp"

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

YAML::Node write_displacement(const SupportOptions& support)
{
  auto node = Components::write(support.displacement);
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
  d.key("boundary", &SupportOptions::boundary, "Boundary that is held.").required();
  d.key("name", &SupportOptions::name, "To refer to it; the boundary if not given.");
  d.custom("displacement",
           "Components by axis, and `normal`: along the boundary's own outward normal, node by node, as for planes of symmetry "
           "and the "
           "cuts of a sector at an angle. One that is not named is free.",
           read_displacement, write_displacement, displacement_schema)
      .required();
}

}  // namespace mortise::constraint
