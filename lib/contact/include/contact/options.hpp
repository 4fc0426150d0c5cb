// The deck's section `contacts`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contact/obstacle.hpp"
#include "deck/description.hpp"
#include "mesh/instances.hpp"

namespace mortise::contact {

/// To add one: a value here and its row in the table of options.cpp.
enum class Law { frictionless, tresca, coulomb, bonded };

/// In the deck; empty without friction.
std::string_view name_of(Law law);

/// How a bonded contact draws its two sides together; exactly one is given.
struct PreloadOptions {
  std::optional<double> force;       ///< tension of the bolt, > 0 (plane models: per thickness; axisymmetric: of the whole turn)
  std::optional<double> shortening;  ///< of the bolt at its pretension section, a length
};

struct Options {
  std::string name;       ///< default: "secondary/primary"
  std::string secondary;  ///< boundary that carries the multipliers
  std::string primary;    ///< empty for an obstacle
  std::optional<Obstacle> obstacle;
  Law law = Law::frictionless;
  double friction = 0;                    ///< tresca: slip bound, a force per area; coulomb: coefficient
  std::string discretization = "mortar";  ///< or "node_to_segment"
  double interference = 0;                ///< added overlap, a length; negative opens a gap
  std::optional<double> adjust = {};      ///< gaps and overlaps of the meshes up to this count as zero; 0: as they are
  std::optional<double> clearance = {};   ///< the gap everywhere, whatever the meshes say, >= 0; interference comes on top
  double search_distance = 0;  ///< surfaces farther apart than this never meet; 0: a tenth of the smaller side's extent
  std::optional<PreloadOptions> preload = {};        ///< bonded contacts alone
  std::optional<mesh::RotationOptions> cyclic = {};  ///< the turn that brings the primary side of a sector to the secondary one
  bool exchanged = false;                            ///< the deck names the two sides the other way round
  bool automatic = false;                            ///< stands for all pairs of bodies that face each other: pairing.hpp
};

/// The deck's entry {auto: true}: what all contacts that are found have in common.
struct AutoOptions {
  Options contact;
};

/// Whether its discretization takes both sides alike, so that either may be the secondary one.
bool sides_are_alike(const Options& options);

/// The keywords.
void describe(deck::Description<PreloadOptions>& d);
void describe(deck::Description<Options>& d);
void describe(deck::Description<AutoOptions>& d);

/// The section: the word auto, or a list of entries of both kinds; read, written, and as a JSON schema. Errors go to the
/// document.
void read_section(std::vector<Options>& contacts, const YAML::Node& node, const std::string& path, deck::Document& document);
YAML::Node write_section(const std::vector<Options>& contacts);
nlohmann::ordered_json section_schema();

}  // namespace mortise::contact
