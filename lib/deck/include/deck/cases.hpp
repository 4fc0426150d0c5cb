// Schemas of values that may be of more than one kind, and of keys that go together.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace mortise::deck {

/// The schema `then` for values that `condition` allows, else `otherwise`. Unlike `anyOf`, which calls the whole value wrong
/// where no alternative fits, an editor then marks the key of the one that is meant.
inline nlohmann::ordered_json schema_by_case(nlohmann::ordered_json condition, nlohmann::ordered_json then,
                                             nlohmann::ordered_json otherwise)
{
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  result["if"] = std::move(condition);
  result["then"] = std::move(then);
  result["else"] = std::move(otherwise);
  return result;
}

using KeyNames = std::vector<std::string>;

/// Mappings that have all of these keys.
inline nlohmann::ordered_json given(const KeyNames& keys)
{
  return {{"required", keys}};
}

namespace detail {
inline nlohmann::ordered_json each_given(const char* word, const KeyNames& keys)
{
  nlohmann::ordered_json result;
  for (const auto& key : keys) result[word].push_back(given({key}));
  return result;
}
}  // namespace detail

/// Mappings that have one of these keys, or more.
inline nlohmann::ordered_json any_given(const KeyNames& keys)
{
  return detail::each_given("anyOf", keys);
}

/// Mappings that have exactly one of these keys.
inline nlohmann::ordered_json one_given(const KeyNames& keys)
{
  return detail::each_given("oneOf", keys);
}

/// Mappings that have none of these keys; an editor marks each that is there.
inline nlohmann::ordered_json none_given(const KeyNames& keys)
{
  nlohmann::ordered_json result;
  for (const auto& key : keys) result["properties"][key] = false;
  return result;
}

/// Mappings whose key, where they have it, fits this schema.
inline nlohmann::ordered_json key_fits(const std::string& key, nlohmann::ordered_json schema)
{
  nlohmann::ordered_json result;
  result["properties"][key] = std::move(schema);
  return result;
}

/// Mappings that have this key, and it fits.
inline nlohmann::ordered_json given_as(const std::string& key, nlohmann::ordered_json schema)
{
  auto result = key_fits(key, std::move(schema));
  result["required"].push_back(key);
  return result;
}

/// What fits all of these.
inline nlohmann::ordered_json all_of(std::initializer_list<nlohmann::ordered_json> rules)
{
  nlohmann::ordered_json result;
  for (const auto& rule : rules) result["allOf"].push_back(rule);
  return result;
}

/// What fits `then` where it fits `condition`.
inline nlohmann::ordered_json when(nlohmann::ordered_json condition, nlohmann::ordered_json then)
{
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  result["if"] = std::move(condition);
  result["then"] = std::move(then);
  return result;
}

}  // namespace mortise::deck
