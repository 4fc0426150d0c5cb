#include "deck/place.hpp"

#include "deck/cases.hpp"

namespace mortise::deck {

void Codec<Place>::read(Place& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits)
{
  if (!node.IsScalar()) return Codec<std::array<double, 3>>::read(value.at, node, path, document, limits);
  Codec<std::string>::read(value.name, node, path, document, {});
  if (value.name.empty()) document.error(path, "expected coordinates, or the name of a curve or a point of the mesh");
}

YAML::Node Codec<Place>::write(const Place& value)
{
  return value.name.empty() ? Codec<std::array<double, 3>>::write(value.at) : YAML::Node(value.name);
}

nlohmann::ordered_json Codec<Place>::schema(const Limits& limits)
{
  const nlohmann::ordered_json name{{"type", "string"}};
  return schema_by_case(name, name, Codec<std::array<double, 3>>::schema(limits));
}

void Codec<std::vector<Place>>::read(std::vector<Place>& value, const YAML::Node& node, const std::string& path,
                                     Document& document, const Limits& limits)
{
  value.clear();
  if (node.IsScalar()) return Codec<Place>::read(value.emplace_back(), node, path, document, limits);
  if (!node.IsSequence()) return document.error(path, "expected a list of places, or a name, found " + found(node));
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto at = path + "[" + std::to_string(i) + "]";
    document.locate(at, node[i]);
    Codec<Place>::read(value.emplace_back(), node[i], at, document, limits);
  }
}

YAML::Node Codec<std::vector<Place>>::write(const std::vector<Place>& value)
{
  YAML::Node node(YAML::NodeType::Sequence);
  for (const auto& place : value) node.push_back(Codec<Place>::write(place));
  return node;
}

nlohmann::ordered_json Codec<std::vector<Place>>::schema(const Limits& limits)
{
  const nlohmann::ordered_json name{{"type", "string"}};
  return schema_by_case(name, name, {{"type", "array"}, {"items", Codec<Place>::schema(limits)}});
}

}  // namespace mortise::deck
