#include "deck/cases.hpp"

namespace mortise::deck {

nlohmann::ordered_json schema_by_case(nlohmann::ordered_json condition, nlohmann::ordered_json then,
                                      nlohmann::ordered_json otherwise)
{
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  result["if"] = std::move(condition);
  result["then"] = std::move(then);
  result["else"] = std::move(otherwise);
  return result;
}

nlohmann::ordered_json given(const KeyNames& keys)
{
  return {{"required", keys}};
}

namespace {

nlohmann::ordered_json each_given(const char* word, const KeyNames& keys)
{
  nlohmann::ordered_json result;
  for (const auto& key : keys) result[word].push_back(given({key}));
  return result;
}

}  // namespace

nlohmann::ordered_json any_given(const KeyNames& keys)
{
  return each_given("anyOf", keys);
}

nlohmann::ordered_json one_given(const KeyNames& keys)
{
  return each_given("oneOf", keys);
}

nlohmann::ordered_json none_given(const KeyNames& keys)
{
  nlohmann::ordered_json result;
  for (const auto& key : keys) result["properties"][key] = false;
  return result;
}

nlohmann::ordered_json key_fits(const std::string& key, nlohmann::ordered_json schema)
{
  nlohmann::ordered_json result;
  result["properties"][key] = std::move(schema);
  return result;
}

nlohmann::ordered_json given_as(const std::string& key, nlohmann::ordered_json schema)
{
  auto result = key_fits(key, std::move(schema));
  result["required"].push_back(key);
  return result;
}

nlohmann::ordered_json all_of(std::initializer_list<nlohmann::ordered_json> rules)
{
  nlohmann::ordered_json result;
  for (const auto& rule : rules) result["allOf"].push_back(rule);
  return result;
}

nlohmann::ordered_json when(nlohmann::ordered_json condition, nlohmann::ordered_json then)
{
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  result["if"] = std::move(condition);
  result["then"] = std::move(then);
  return result;
}

}  // namespace mortise::deck
