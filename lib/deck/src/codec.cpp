#include "deck/codec.hpp"

#include <fmt/format.h>

#include <cmath>

#include "deck/description.hpp"
#include "scan.hpp"

namespace mortise::deck {

namespace {

std::string expectation(const Limits& limits, const char* kind)
{
  std::string text = kind;
  if (std::isfinite(limits.lower)) text += fmt::format(" {} {:g}", limits.strictly_above ? ">" : ">=", limits.lower);
  if (std::isfinite(limits.upper))
    text +=
        fmt::format("{} {} {:g}", std::isfinite(limits.lower) ? " and" : "", limits.strictly_below ? "<" : "<=", limits.upper);
  return text;
}

bool inside(double value, const Limits& limits)
{
  return (limits.strictly_above ? value > limits.lower : value >= limits.lower) &&
         (limits.strictly_below ? value < limits.upper : value <= limits.upper);
}

nlohmann::ordered_json with_limits(nlohmann::ordered_json schema, const Limits& limits)
{
  if (std::isfinite(limits.lower)) schema[limits.strictly_above ? "exclusiveMinimum" : "minimum"] = limits.lower;
  if (std::isfinite(limits.upper)) schema[limits.strictly_below ? "exclusiveMaximum" : "maximum"] = limits.upper;
  return schema;
}

// yaml-cpp reads "1e-4" but also ".inf"; a whole scalar must be a finite number.
bool number(const YAML::Node& node, double& value)
{
  return node.IsScalar() && YAML::convert<double>::decode(node, value) && std::isfinite(value);
}

// Beyond these, areas, volumes and energies of what is told in them overflow or vanish.
constexpr double largest = 1e50, smallest = 1e-50;

}  // namespace

void Codec<double>::read(double& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits)
{
  double read = 0;
  if (!number(node, read) || !inside(read, limits))
    document.error(path, fmt::format("expected {}, found {}", expectation(limits, "a number"), found(node)));
  else if (std::abs(read) > largest || (read != 0 && std::abs(read) < smallest))
    document.error(path, fmt::format("{} is too {} to compute with; expected 0 or a size of {:g} to {:g}: take other units",
                                     found(node), std::abs(read) > 1 ? "large" : "small", smallest, largest));
  else
    value = read;
}

YAML::Node Codec<double>::write(double value)
{
  return YAML::Node(fmt::format("{}", value));
}

nlohmann::ordered_json Codec<double>::schema(const Limits& limits)
{
  return with_limits({{"type", "number"}}, limits);
}

void Codec<int>::read(int& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits)
{
  double read = 0;
  if (number(node, read) && read == std::floor(read) && std::abs(read) <= std::numeric_limits<int>::max() && inside(read, limits))
    value = static_cast<int>(read);
  else
    document.error(path, fmt::format("expected {}, found {}", expectation(limits, "a whole number"), found(node)));
}

nlohmann::ordered_json Codec<int>::schema(const Limits& limits)
{
  return with_limits({{"type", "integer"}}, limits);
}

void Codec<bool>::read(bool& value, const YAML::Node& node, const std::string& path, Document& document, const Limits&)
{
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value))
    document.error(path, "expected true or false, found " + found(node));
}

nlohmann::ordered_json Codec<bool>::schema(const Limits&)
{
  return {{"type", "boolean"}};
}

void Codec<std::string>::read(std::string& value, const YAML::Node& node, const std::string& path, Document& document,
                              const Limits& limits)
{
  if (!node.IsScalar()) {
    document.error(path, "expected a word, found " + found(node));
    return;
  }
  const auto& word = node.Scalar();
  const auto control = std::find_if(word.begin(), word.end(), is_control);  // by an escape such as "\0", within quotes
  if (control != word.end()) {
    document.error(path, fmt::format("character {} of the value is no text (code {:#04x}); remove it", control - word.begin() + 1,
                                     static_cast<unsigned char>(*control)));
    return;
  }
  value = word;
  if (limits.names.empty() || std::find(limits.names.begin(), limits.names.end(), value) != limits.names.end()) return;
  document.error(path, fmt::format("unknown value \"{}\"{}", value, suggestion(value, limits.names)));
}

nlohmann::ordered_json Codec<std::string>::schema(const Limits& limits)
{
  nlohmann::ordered_json result{{"type", "string"}};
  if (!limits.names.empty()) result["enum"] = limits.names;
  return result;
}

void for_each_entry(const YAML::Node& node, const std::string& path, Document& document,
                    const std::function<void(const YAML::Node& entry, const std::string& at)>& read)
{
  if (node.IsNull()) return;
  if (!node.IsSequence()) {
    document.error(path, "expected a list, found " + found(node));
    return;
  }
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto at = path + "[" + std::to_string(i) + "]";
    const YAML::Node entry = node[i];
    document.locate(at, entry);
    read(entry, at);
  }
}

void for_each_named(const YAML::Node& node, const std::string& path, Document& document,
                    const std::function<bool(const std::string& name, const YAML::Node& entry, const std::string& at)>& read)
{
  if (node.IsNull()) return;
  if (!node.IsMap()) {
    document.error(path, "expected a mapping of names, found " + found(node));
    return;
  }
  for (const auto& entry : node) {
    const auto name = entry.first.Scalar();
    const auto at = path + "." + name;
    document.locate(at, entry.first);
    if (!read(name, entry.second, at)) document.error(at, "is given twice");
  }
}

bool is_vector(const YAML::Node& node, std::size_t most, const std::string& path, Document& document)
{
  if (node.IsSequence() && node.size() >= 2 && node.size() <= most) return true;
  document.error(path, "expected a list of 2 (plane models) or 3 entries, found " +
                           (node.IsSequence() ? std::to_string(node.size()) + " entries" : found(node)));
  return false;
}

YAML::Node list_of(const std::vector<YAML::Node>& entries, YAML::EmitterStyle::value style)
{
  YAML::Node node(YAML::NodeType::Sequence);
  for (const auto& entry : entries) node.push_back(entry);
  node.SetStyle(style);
  return node;
}

nlohmann::ordered_json or_auto(nlohmann::ordered_json schema)
{
  return {{"anyOf", {{{"const", "auto"}}, std::move(schema)}}};
}

nlohmann::ordered_json vector_of(nlohmann::ordered_json schema, std::size_t most)
{
  return {{"type", "array"}, {"items", std::move(schema)}, {"minItems", 2}, {"maxItems", most}};
}

nlohmann::ordered_json list_of(nlohmann::ordered_json schema)
{
  return {{"type", "array"}, {"items", std::move(schema)}};
}

nlohmann::ordered_json mapping_of(nlohmann::ordered_json schema)
{
  return {{"type", "object"}, {"additionalProperties", std::move(schema)}};
}

void Codec<std::array<std::optional<double>, 3>>::read(Value& value, const YAML::Node& node, const std::string& path,
                                                       Document& document, const Limits& limits)
{
  if (!node.IsMap() || node.size() == 0) {
    document.error(path, "expected components such as {x: 0, y: 0}, found " + found(node));
    return;
  }
  for (const auto& entry : node) {
    const auto name = entry.first.Scalar();
    const auto at = path + "." + name;
    document.locate(at, entry.first);
    const auto axis = std::string("xyz").find(name);
    if (name.size() != 1 || axis == std::string::npos)
      document.error(at, "unknown component, expected x, y or z");
    else if (value[axis])
      document.error(at, "is given twice");
    else
      Codec<double>::read(value[axis].emplace(), entry.second, at, document, limits);
  }
}

YAML::Node Codec<std::array<std::optional<double>, 3>>::write(const Value& value)
{
  YAML::Node node(YAML::NodeType::Map);
  for (std::size_t c = 0; c < 3; ++c)
    if (value[c]) node[std::string(1, "xyz"[c])] = Codec<double>::write(*value[c]);
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

nlohmann::ordered_json Codec<std::array<std::optional<double>, 3>>::schema(const Limits& limits)
{
  const auto number = Codec<double>::schema(limits);
  return {{"type", "object"},
          {"properties", {{"x", number}, {"y", number}, {"z", number}}},
          {"additionalProperties", false},
          {"minProperties", 1}};
}

nlohmann::ordered_json default_value(const YAML::Node& written)
{
  if (written.IsScalar()) {
    const auto& text = written.Scalar();
    bool truth = false;
    double number = 0;
    if (text.empty()) return nullptr;
    if (text == "true" || text == "false") return YAML::convert<bool>::decode(written, truth) && truth;
    if (!YAML::convert<double>::decode(written, number)) return text;
    if (!std::isfinite(number)) return nullptr;
    if (number == std::trunc(number) && std::abs(number) < 1e15) return static_cast<long long>(number);
    return number;
  }
  if (!written.IsSequence() || written.size() == 0) return nullptr;
  auto list = nlohmann::ordered_json::array();
  for (const auto& entry : written) {
    auto value = default_value(entry);
    if (value.is_null()) return nullptr;
    list.push_back(std::move(value));
  }
  return list;
}

}  // namespace mortise::deck
