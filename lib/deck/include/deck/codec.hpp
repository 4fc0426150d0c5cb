// How values of each type are read, written back and described: to add a type, specialise Codec.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deck/document.hpp"

namespace mortise::deck {

/// What a value must satisfy; for lists, each entry.
struct Limits {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool strictly_above = false, strictly_below = false;  ///< the limits themselves are not allowed
  std::vector<std::string> names;                       ///< allowed strings; empty: all
};

/// read() sets `value` from a node of the deck, or leaves an error about `path` in the document; write() gives the node that
/// reads back to the value, null for what need not be written; schema() is its JSON schema.
template <class V>
struct Codec;

template <>
struct Codec<double> {
  static void read(double& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(double value);
  static nlohmann::ordered_json schema(const Limits& limits);
};
template <>
struct Codec<int> {
  static void read(int& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(int value) { return YAML::Node(value); }
  static nlohmann::ordered_json schema(const Limits& limits);
};
template <>
struct Codec<bool> {
  static void read(bool& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(bool value) { return YAML::Node(value); }
  static nlohmann::ordered_json schema(const Limits& limits);
};
template <>
struct Codec<std::string> {
  static void read(std::string& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(const std::string& value) { return value.empty() ? YAML::Node() : YAML::Node(value); }
  static nlohmann::ordered_json schema(const Limits& limits);
};

// What the templates below share, whatever they hold.

/// Calls `read` for the entries of a list (none of null), with their paths. An error if it is no list.
void for_each_entry(const YAML::Node& node, const std::string& path, Document& document,
                    const std::function<void(const YAML::Node& entry, const std::string& at)>& read);
/// The same for the entries of a mapping of names; `read` returns whether the name was new.
void for_each_named(const YAML::Node& node, const std::string& path, Document& document,
                    const std::function<bool(const std::string& name, const YAML::Node& entry, const std::string& at)>& read);
/// Whether it is a list of two or `most` entries; an error if it is not.
bool is_vector(const YAML::Node& node, std::size_t most, const std::string& path, Document& document);
/// The node of a list, and schemas made of that of an entry.
YAML::Node list_of(const std::vector<YAML::Node>& entries, YAML::EmitterStyle::value style = YAML::EmitterStyle::Default);
nlohmann::ordered_json or_auto(nlohmann::ordered_json schema);
nlohmann::ordered_json vector_of(nlohmann::ordered_json schema, std::size_t most);
nlohmann::ordered_json list_of(nlohmann::ordered_json schema);
nlohmann::ordered_json mapping_of(nlohmann::ordered_json schema);

/// An absent value is not written back.
template <class V>
struct Codec<std::optional<V>> {
  static void read(std::optional<V>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    value.emplace();
    Codec<V>::read(*value, node, path, document, limits);
  }
  static YAML::Node write(const std::optional<V>& value) { return value ? Codec<V>::write(*value) : YAML::Node(); }
  static nlohmann::ordered_json schema(const Limits& limits) { return Codec<V>::schema(limits); }
};

/// A value, or the word auto where the program finds one.
template <class V>
struct OrAuto {
  std::optional<V> value;
};

template <class V>
struct Codec<OrAuto<V>> {
  static void read(OrAuto<V>& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits)
  {
    if (node.IsScalar() && node.Scalar() == "auto")
      value.value.reset();
    else
      Codec<V>::read(value.value.emplace(), node, path, document, limits);
  }
  static YAML::Node write(const OrAuto<V>& value) { return value.value ? Codec<V>::write(*value.value) : YAML::Node("auto"); }
  static nlohmann::ordered_json schema(const Limits& limits) { return or_auto(Codec<V>::schema(limits)); }
};

/// Vectors in space: two or three entries; what is not given stays as it is.
template <class V, std::size_t N>
struct Codec<std::array<V, N>> {
  static void read(std::array<V, N>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    if (!is_vector(node, N, path, document)) return;
    if (node.size() < N) {
      value[N - 1] = V{};
      document.note_pair(path);
    }
    for (std::size_t i = 0; i < node.size(); ++i)
      Codec<V>::read(value[i], node[i], path + "[" + std::to_string(i) + "]", document, limits);
  }
  static YAML::Node write(const std::array<V, N>& value)
  {
    std::vector<YAML::Node> entries;
    for (const auto& entry : value) entries.push_back(Codec<V>::write(entry));
    return list_of(entries, YAML::EmitterStyle::Flow);
  }
  static nlohmann::ordered_json schema(const Limits& limits) { return vector_of(Codec<V>::schema(limits), N); }
};

template <class V>
struct Codec<std::vector<V>> {
  static void read(std::vector<V>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    value.clear();
    for_each_entry(node, path, document, [&](const YAML::Node& entry, const std::string& at) {
      V item{};
      Codec<V>::read(item, entry, at, document, limits);
      value.push_back(std::move(item));
    });
  }
  static YAML::Node write(const std::vector<V>& value)
  {
    std::vector<YAML::Node> entries;
    for (const auto& entry : value) entries.push_back(Codec<V>::write(entry));
    return list_of(entries);
  }
  static nlohmann::ordered_json schema(const Limits& limits) { return list_of(Codec<V>::schema(limits)); }
};

/// Entries by name.
template <class V>
struct Codec<std::map<std::string, V>> {
  static void read(std::map<std::string, V>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    value.clear();
    for_each_named(node, path, document, [&](const std::string& name, const YAML::Node& entry, const std::string& at) {
      V item{};
      Codec<V>::read(item, entry, at, document, limits);
      return value.emplace(name, std::move(item)).second;
    });
  }
  static YAML::Node write(const std::map<std::string, V>& value)
  {
    YAML::Node node(YAML::NodeType::Map);
    for (const auto& [name, item] : value) node[name] = Codec<V>::write(item);
    return value.empty() ? YAML::Node() : node;
  }
  static nlohmann::ordered_json schema(const Limits& limits) { return mapping_of(Codec<V>::schema(limits)); }
};

/// Components by axis, {x: 0, z: 1}; an axis that is not named has no value.
template <>
struct Codec<std::array<std::optional<double>, 3>> {
  using Value = std::array<std::optional<double>, 3>;
  static void read(Value& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(const Value& value);
  static nlohmann::ordered_json schema(const Limits& limits);
};

}  // namespace mortise::deck
