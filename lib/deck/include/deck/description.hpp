// Keywords, declared once beside the code that uses them:
//
//     void describe(deck::Description<Options>& d)   // in the namespace of Options
//     {
//       d.help("How the quadratic programme is solved.");
//       d.key("tolerance", &Options::tolerance, "Relative residual at which the solver stops.").positive();
//     }
//
// From a description come reading with checks, the deck with all defaults filled in, and a JSON schema.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "deck/codec.hpp"

namespace mortise::deck {

/// One keyword of T. Its modifiers return itself, so that they can be strung together.
template <class T>
class Key {
 public:
  std::string name, help;
  Limits limits;
  bool is_required = false;
  bool is_hidden = false;  ///< not written back while it has its initial value
  std::function<void(T&, const YAML::Node&, const std::string& path, Document&, const Limits&)> read;
  std::function<YAML::Node(const T&)> write;
  std::function<nlohmann::ordered_json(const Limits&)> schema;

  Key& required() { return is_required = true, *this; }
  Key& hidden() { return is_hidden = true, *this; }
  Key& positive() { return limits.lower = 0, limits.strictly_above = true, *this; }
  Key& at_least(double value) { return limits.lower = value, limits.strictly_above = false, *this; }
  Key& above(double value) { return limits.lower = value, limits.strictly_above = true, *this; }
  Key& below(double value) { return limits.upper = value, limits.strictly_below = true, *this; }
  Key& one_of(std::vector<std::string> names) { return limits.names = std::move(names), *this; }
  /// Names that a later version will know.
  Key& not_yet(std::vector<std::string> names) { return limits.future = std::move(names), *this; }
};

template <class T>
class Description {
 public:
  void help(std::string text) { help_ = std::move(text); }

  /// Binds a member. Its type must have a Codec or a describe() of its own.
  template <class V>
  Key<T>& key(const std::string& name, V T::*member, const std::string& help)
  {
    return custom(
        name, help,
        [member](T& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits) {
          Codec<V>::read(value.*member, node, path, document, limits);
        },
        [member](const T& value) { return Codec<V>::write(value.*member); },
        [](const Limits& limits) { return Codec<V>::schema(limits); });
  }

  /// A keyword with functions of its own.
  Key<T>& custom(const std::string& name, const std::string& help, decltype(Key<T>::read) read, decltype(Key<T>::write) write,
                 decltype(Key<T>::schema) schema)
  {
    keys_.push_back(std::make_unique<Key<T>>());
    Key<T>& key = *keys_.back();
    key.name = name;
    key.help = help;
    key.read = std::move(read);
    key.write = std::move(write);
    key.schema = std::move(schema);
    return key;
  }

  /// A keyword that the format knows and this version cannot do.
  void unavailable(const std::string& name) { unavailable_.push_back(name); }

  /// A check of the whole once its keys are read without error: reports to the document.
  void check(std::function<void(const T&, const std::string& path, Document&)> function) { check_ = std::move(function); }

  /// A check of which keys are given: which of them go together.
  void check_keys(std::function<void(const std::vector<std::string>& given, const std::string& path, Document&)> function)
  {
    key_check_ = std::move(function);
  }

  /// What of its keys goes together, as a schema (cases.hpp): tells editors what the checks tell those who run the program.
  void rule(nlohmann::ordered_json schema) { rules_.push_back(std::move(schema)); }

  const std::vector<std::unique_ptr<Key<T>>>& keys() const { return keys_; }
  const std::vector<std::string>& unavailable() const { return unavailable_; }
  const std::string& help() const { return help_; }
  const auto& whole_check() const { return check_; }
  const auto& key_check() const { return key_check_; }
  const std::vector<nlohmann::ordered_json>& rules() const { return rules_; }

 private:
  std::string help_;
  std::vector<std::unique_ptr<Key<T>>> keys_;
  std::vector<std::string> unavailable_;
  std::function<void(const T&, const std::string&, Document&)> check_;
  std::function<void(const std::vector<std::string>&, const std::string&, Document&)> key_check_;
  std::vector<nlohmann::ordered_json> rules_;
};

/// The description of T, made once.
template <class T>
const Description<T>& description()
{
  static const auto made = [] {
    Description<T> d;
    describe(d);
    return d;
  }();
  return made;
}

/// What a key is without being given, as JSON: scalars and lists of them; null for what is absent, empty or a mapping.
nlohmann::ordered_json default_value(const YAML::Node& written);

inline std::string join(const std::string& path, const std::string& key)
{
  return path.empty() ? key : path + "." + key;
}

/// Structs with a description.
template <class T>
struct Codec {
  static void read(T& value, const YAML::Node& node, const std::string& path, Document& document, const Limits&)
  {
    const auto& d = description<T>();
    if (!node.IsMap()) {
      document.error(path, "expected a mapping, found " + found(node));
      return;
    }
    const auto before = document.error_count();
    std::vector<std::string> seen, names;
    for (const auto& key : d.keys()) names.push_back(key->name);
    for (const auto& entry : node) {
      const auto name = entry.first.Scalar();
      const auto at = join(path, name);
      document.locate(at, entry.first);
      if (std::find(seen.begin(), seen.end(), name) != seen.end()) document.error(at, "is given twice");
      seen.push_back(name);
      const auto key = std::find_if(d.keys().begin(), d.keys().end(), [&](const auto& k) { return k->name == name; });
      if (key != d.keys().end())
        (*key)->read(value, entry.second, at, document, (*key)->limits);
      else if (std::find(d.unavailable().begin(), d.unavailable().end(), name) != d.unavailable().end())
        document.error(at, "is not available in this version of Mortise");
      else
        document.error(at, "unknown key" + suggestion(name, names));
    }
    for (const auto& key : d.keys())
      if (key->is_required && std::find(seen.begin(), seen.end(), key->name) == seen.end())
        document.error(path, "the key \"" + key->name + "\" is missing: " + key->help);
    if (d.key_check()) d.key_check()(seen, path, document);
    if (document.error_count() == before && d.whole_check()) d.whole_check()(value, path, document);
  }
  static YAML::Node write(const T& value)
  {
    YAML::Node node(YAML::NodeType::Map);
    const T initial{};
    for (const auto& key : description<T>().keys()) {
      const auto written = key->write(value);
      if (!written.IsDefined() || written.IsNull()) continue;
      if (key->is_hidden && YAML::Dump(written) == YAML::Dump(key->write(initial))) continue;
      node[key->name] = written;
    }
    return node;
  }
  static nlohmann::ordered_json schema(const Limits&)
  {
    const auto& d = description<T>();
    nlohmann::ordered_json result{{"type", "object"}, {"description", d.help()}, {"additionalProperties", false}};
    result["properties"] = nlohmann::ordered_json::object();
    const T initial{};
    for (const auto& key : d.keys()) {
      auto property = key->schema(key->limits);
      property["description"] = key->help;
      if (!key->is_required)
        if (auto value = default_value(key->write(initial)); !value.is_null()) property["default"] = std::move(value);
      result["properties"][key->name] = property;
      if (key->is_required) result["required"].push_back(key->name);
    }
    if (!d.rules().empty()) result["allOf"] = d.rules();
    return result;
  }
};

/// Reads the whole document into T and throws Error(bad_input) with everything that is wrong.
template <class T>
void read(T& value, Document& document)
{
  Codec<T>::read(value, document.root(), "", document, {});
}

/// JSON schema (draft 2020-12) of a deck, of this name.
template <class T>
nlohmann::ordered_json schema(const std::string& id)
{
  nlohmann::ordered_json result{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", id}};
  result.update(Codec<T>::schema({}));
  return result;
}

}  // namespace mortise::deck
