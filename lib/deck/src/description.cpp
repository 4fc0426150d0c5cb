#include "deck/description.hpp"

#include <algorithm>

namespace mortise::deck {

std::string join(const std::string& path, const std::string& key)
{
  return path.empty() ? key : path + "." + key;
}

void AnyDescription::rule(nlohmann::ordered_json schema)
{
  rules_.push_back(std::move(schema));
}

bool AnyDescription::read(void* value, const YAML::Node& node, const std::string& path, Document& document) const
{
  if (!node.IsMap()) {
    document.error(path, "expected a mapping, found " + found(node));
    return false;
  }
  const auto before = document.error_count();
  std::vector<std::string> seen, names;
  for (const auto* key : all_) names.push_back(key->name);
  for (const auto& entry : node) {
    const auto name = entry.first.Scalar();
    const auto at = join(path, name);
    document.locate(at, entry.first);
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) document.error(at, "is given twice");
    seen.push_back(name);
    const auto key = std::find_if(all_.begin(), all_.end(), [&](const auto* k) { return k->name == name; });
    if (key != all_.end())
      (*key)->read_any(value, entry.second, at, document, (*key)->limits);
    else
      document.error(at, "unknown key" + suggestion(name, names));
  }
  for (const auto* key : all_)
    if (key->is_required && std::find(seen.begin(), seen.end(), key->name) == seen.end())
      document.error(path, "the key \"" + key->name + "\" is missing: " + key->help);
  if (key_check_) key_check_(seen, path, document);
  return document.error_count() == before;
}

YAML::Node AnyDescription::write(const void* value, const void* initial) const
{
  YAML::Node node(YAML::NodeType::Map);
  for (const auto* key : all_) {
    const auto written = key->write_any(value);
    if (!written.IsDefined() || written.IsNull()) continue;
    // An empty list is no value, but a key that is there: rules about which keys go together would take it for one.
    const bool is_nothing = key->is_hidden || (written.IsSequence() && written.size() == 0);
    if (is_nothing && YAML::Dump(written) == YAML::Dump(key->write_any(initial))) continue;
    node[key->name] = written;
  }
  return node;
}

nlohmann::ordered_json AnyDescription::schema(const void* initial) const
{
  nlohmann::ordered_json result{{"type", "object"}, {"description", help_}, {"additionalProperties", false}};
  result["properties"] = nlohmann::ordered_json::object();
  for (const auto* key : all_) {
    auto property = key->schema(key->limits);
    property["description"] = key->help;
    if (!key->is_required)
      if (auto value = default_value(key->write_any(initial)); !value.is_null()) property["default"] = std::move(value);
    result["properties"][key->name] = property;
    if (key->is_required) result["required"].push_back(key->name);
  }
  if (!rules_.empty()) result["allOf"] = rules_;
  return result;
}

nlohmann::ordered_json named_schema(const std::string& id, const nlohmann::ordered_json& schema)
{
  nlohmann::ordered_json result{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", id}};
  result.update(schema);
  return result;
}

}  // namespace mortise::deck
