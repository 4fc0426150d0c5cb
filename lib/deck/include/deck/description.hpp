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

/// A keyword of a struct of any type, which its functions are handed by address.
struct AnyKey {
  std::string name, help;
  Limits limits;
  bool is_required = false;
  bool is_hidden = false;  ///< a key that is not written back while it has its initial value
  std::function<void(void*, const YAML::Node&, const std::string& path, Document&, const Limits&)> read_any;
  std::function<YAML::Node(const void*)> write_any;
  std::function<nlohmann::ordered_json(const Limits&)> schema;
};

/// One keyword of T. Its modifiers return itself, so that they can be strung together.
template <class T>
class Key : public AnyKey {
 public:
  void read(T& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits) const
  {
    read_any(&value, node, path, document, limits);
  }
  YAML::Node write(const T& value) const { return write_any(&value); }

  /// It must be given.
  Key& required() { return is_required = true, *this; }
  Key& hidden() { return is_hidden = true, *this; }
  /// Limits of a number, or of each entry of a list.
  Key& positive() { return limits.lower = 0, limits.strictly_above = true, *this; }
  Key& at_least(double value) { return limits.lower = value, limits.strictly_above = false, *this; }
  Key& above(double value) { return limits.lower = value, limits.strictly_above = true, *this; }
  Key& below(double value) { return limits.upper = value, limits.strictly_below = true, *this; }
  /// The strings that it may be.
  Key& one_of(std::vector<std::string> names) { return limits.names = std::move(names), *this; }
};

/// What descriptions of all types share, compiled once: every struct of a deck would have functions of its own, of some 20 kB.
class AnyDescription {
 public:
  /// What the section or entry is for: a paragraph of the manual.
  void help(std::string text) { help_ = std::move(text); }
  /// A check of which keys are given: which of them go together.
  void check_keys(std::function<void(const std::vector<std::string>& given, const std::string& path, Document&)> function)
  {
    key_check_ = std::move(function);
  }
  /// What of its keys goes together, as a schema (cases.hpp): tells editors what the checks tell those who run the program.
  void rule(nlohmann::ordered_json schema);

  /// Reads a mapping into the struct at `value`, of the type described. Returns whether there was no error.
  bool read(void* value, const YAML::Node& node, const std::string& path, Document& document) const;
  /// The mapping of the struct at `value`; `initial`: one with all initial values.
  YAML::Node write(const void* value, const void* initial) const;
  nlohmann::ordered_json schema(const void* initial) const;

 protected:
  std::vector<const AnyKey*> all_;

 private:
  std::string help_;
  std::function<void(const std::vector<std::string>&, const std::string&, Document&)> key_check_;
  std::vector<nlohmann::ordered_json> rules_;
};

template <class T>
class Description : public AnyDescription {
 public:
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

  /// A keyword with functions of its own: read(T&, node, path, Document&, const Limits&), write(const T&).
  template <class Read, class Write>
  Key<T>& custom(const std::string& name, const std::string& help, Read read, Write write, decltype(AnyKey::schema) schema)
  {
    keys_.push_back(std::make_unique<Key<T>>());
    Key<T>& key = *keys_.back();
    all_.push_back(&key);
    key.name = name;
    key.help = help;
    key.read_any = [read](void* value, const YAML::Node& node, const std::string& path, Document& document,
                          const Limits& limits) { read(*static_cast<T*>(value), node, path, document, limits); };
    key.write_any = [write](const void* value) { return write(*static_cast<const T*>(value)); };
    key.schema = std::move(schema);
    return key;
  }

  /// A check of the whole once its keys are read without error: reports to the document.
  void check(std::function<void(const T&, const std::string& path, Document&)> function) { check_ = std::move(function); }

  const std::vector<std::unique_ptr<Key<T>>>& keys() const { return keys_; }
  const auto& whole_check() const { return check_; }

 private:
  std::vector<std::unique_ptr<Key<T>>> keys_;
  std::function<void(const T&, const std::string&, Document&)> check_;
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

/// "path.key", or "key" at the top.
std::string join(const std::string& path, const std::string& key);

/// Structs with a description.
template <class T>
struct Codec {
  static void read(T& value, const YAML::Node& node, const std::string& path, Document& document, const Limits&)
  {
    const auto& d = description<T>();
    if (d.read(&value, node, path, document) && d.whole_check()) d.whole_check()(value, path, document);
  }
  static YAML::Node write(const T& value)
  {
    const T initial{};
    return description<T>().write(&value, &initial);
  }
  static nlohmann::ordered_json schema(const Limits&)
  {
    const T initial{};
    return description<T>().schema(&initial);
  }
};

/// Reads the whole document into T and throws Error(bad_input) with everything that is wrong.
template <class T>
void read(T& value, Document& document)
{
  Codec<T>::read(value, document.root(), "", document, {});
}

/// A schema under this name, of draft 2020-12.
nlohmann::ordered_json named_schema(const std::string& id, const nlohmann::ordered_json& schema);

/// JSON schema (draft 2020-12) of a deck, of this name.
template <class T>
nlohmann::ordered_json schema(const std::string& id)
{
  return named_schema(id, Codec<T>::schema({}));
}

}  // namespace mortise::deck
