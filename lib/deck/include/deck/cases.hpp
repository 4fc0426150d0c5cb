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
nlohmann::ordered_json schema_by_case(nlohmann::ordered_json condition, nlohmann::ordered_json then,
                                      nlohmann::ordered_json otherwise);

using KeyNames = std::vector<std::string>;

/// Mappings that have all of these keys.
nlohmann::ordered_json given(const KeyNames& keys);

/// Mappings that have one of these keys, or more.
nlohmann::ordered_json any_given(const KeyNames& keys);

/// Mappings that have exactly one of these keys.
nlohmann::ordered_json one_given(const KeyNames& keys);

/// Mappings that have none of these keys; an editor marks each that is there.
nlohmann::ordered_json none_given(const KeyNames& keys);

/// Mappings whose key, where they have it, fits this schema.
nlohmann::ordered_json key_fits(const std::string& key, nlohmann::ordered_json schema);

/// Mappings that have this key, and it fits.
nlohmann::ordered_json given_as(const std::string& key, nlohmann::ordered_json schema);

/// What fits all of these.
nlohmann::ordered_json all_of(std::initializer_list<nlohmann::ordered_json> rules);

/// What fits `then` where it fits `condition`.
nlohmann::ordered_json when(nlohmann::ordered_json condition, nlohmann::ordered_json then);

}  // namespace mortise::deck
