// How values of each type are read, written back and described: to add a type, specialise Codec.
#pragma once

#include <algorithm>
#include <array>
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
  bool strictly_above = false, strictly_below = false;
  std::vector<std::string> names;   ///< allowed strings; empty: all
  std::vector<std::string> future;  ///< strings that are refused as not available yet
};

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
  static nlohmann::ordered_json schema(const Limits&) { return {{"type", "boolean"}}; }
};
template <>
struct Codec<std::string> {
  static void read(std::string& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(const std::string& value) { return value.empty() ? YAML::Node() : YAML::Node(value); }
  static nlohmann::ordered_json schema(const Limits& limits);
};

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
  static nlohmann::ordered_json schema(const Limits& limits)
  {
    return {{"anyOf", {{{"const", "auto"}}, Codec<V>::schema(limits)}}};
  }
};

/// Vectors in space: two or three entries; what is not given stays as it is.
template <class V, std::size_t N>
struct Codec<std::array<V, N>> {
  static void read(std::array<V, N>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    if (!node.IsSequence() || node.size() < 2 || node.size() > N) {
      document.error(path, "expected a list of 2 (plane models) or 3 entries, found " +
                               (node.IsSequence() ? std::to_string(node.size()) + " entries" : found(node)));
      return;
    }
    if (node.size() < N) {
      value[N - 1] = V{};
      document.note_pair(path);
    }
    for (std::size_t i = 0; i < node.size(); ++i)
      Codec<V>::read(value[i], node[i], path + "[" + std::to_string(i) + "]", document, limits);
  }
  static YAML::Node write(const std::array<V, N>& value)
  {
    YAML::Node node(YAML::NodeType::Sequence);
    for (const auto& entry : value) node.push_back(Codec<V>::write(entry));
    node.SetStyle(YAML::EmitterStyle::Flow);
    return node;
  }
  static nlohmann::ordered_json schema(const Limits& limits)
  {
    return {{"type", "array"}, {"items", Codec<V>::schema(limits)}, {"minItems", 2}, {"maxItems", N}};
  }
};

template <class V>
struct Codec<std::vector<V>> {
  static void read(std::vector<V>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    value.clear();
    if (node.IsNull()) return;
    if (!node.IsSequence()) {
      document.error(path, "expected a list, found " + found(node));
      return;
    }
    for (std::size_t i = 0; i < node.size(); ++i) {
      const auto at = path + "[" + std::to_string(i) + "]";
      document.locate(at, node[i]);
      V entry{};
      Codec<V>::read(entry, node[i], at, document, limits);
      value.push_back(std::move(entry));
    }
  }
  static YAML::Node write(const std::vector<V>& value)
  {
    YAML::Node node(YAML::NodeType::Sequence);
    for (const auto& entry : value) node.push_back(Codec<V>::write(entry));
    return node;
  }
  static nlohmann::ordered_json schema(const Limits& limits) { return {{"type", "array"}, {"items", Codec<V>::schema(limits)}}; }
};

/// Entries by name.
template <class V>
struct Codec<std::map<std::string, V>> {
  static void read(std::map<std::string, V>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits)
  {
    value.clear();
    if (node.IsNull()) return;
    if (!node.IsMap()) {
      document.error(path, "expected a mapping of names, found " + found(node));
      return;
    }
    for (const auto& entry : node) {
      const auto name = entry.first.Scalar();
      const auto at = path + "." + name;
      document.locate(at, entry.first);
      V item{};
      Codec<V>::read(item, entry.second, at, document, limits);
      if (!value.emplace(name, std::move(item)).second) document.error(at, "is given twice");
    }
  }
  static YAML::Node write(const std::map<std::string, V>& value)
  {
    YAML::Node node(YAML::NodeType::Map);
    for (const auto& [name, item] : value) node[name] = Codec<V>::write(item);
    return value.empty() ? YAML::Node() : node;
  }
  static nlohmann::ordered_json schema(const Limits& limits)
  {
    return {{"type", "object"}, {"additionalProperties", Codec<V>::schema(limits)}};
  }
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
