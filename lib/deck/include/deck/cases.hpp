// Schemas of values that may be of more than one kind.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>

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

}  // namespace mortise::deck
