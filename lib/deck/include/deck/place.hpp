// Where nodes are: at coordinates, or under a name that they have in the mesh.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "deck/codec.hpp"

namespace mortise::deck {

/// One or many nodes.
struct Place {
  std::string name;            ///< of nodes in the mesh: a physical curve or point, an *NSET; empty: coordinates
  std::array<double, 3> at{};  ///< if it has no name
  bool operator==(const Place&) const = default;
};

/// `tip`, or [0, 0, 1].
template <>
struct Codec<Place> {
  static void read(Place& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(const Place& value);
  static nlohmann::ordered_json schema(const Limits& limits);
};

/// A list of places, or one name.
template <>
struct Codec<std::vector<Place>> {
  static void read(std::vector<Place>& value, const YAML::Node& node, const std::string& path, Document& document,
                   const Limits& limits);
  static YAML::Node write(const std::vector<Place>& value);
  static nlohmann::ordered_json schema(const Limits& limits);
};

}  // namespace mortise::deck
