#include "contact/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "deck/cases.hpp"
#include "rows/discretization.hpp"

namespace mortise::contact {

namespace {

// One law as the deck has it: its name, and a value or true.
struct LawKind {
  std::string_view name;
  Law law;
  bool has_value;
  std::string_view example, value;  // what stands behind the name, and what it is
};

// The table.
constexpr std::array laws{LawKind{"coulomb", Law::coulomb, true, "0.3", "coefficient"},
                          LawKind{"tresca", Law::tresca, true, "25.0", "slip bound as a traction"},
                          LawKind{"bonded", Law::bonded, false, "true", "true"}};

// "{coulomb: 0.3}, {tresca: 25.0} and {bonded: true}".
std::string all_laws(std::string_view LawKind::*behind, const char* last)
{
  std::string text;
  for (std::size_t i = 0; i < laws.size(); ++i)
    text += fmt::format("{}{{{}: {}}}", i == 0 ? "" : i + 1 < laws.size() ? ", " : last, laws[i].name, laws[i].*behind);
  return text;
}

// friction: {coulomb: 0.3} | {tresca: 25} | {bonded: true}
void read_friction(Options& contact, const YAML::Node& node, const std::string& path, deck::Document& document,
                   const deck::Limits&)
{
  if (!node.IsMap() || node.size() != 1) {
    document.error(path, "expected one of " + all_laws(&LawKind::example, " and ") + ", found " + deck::found(node));
    return;
  }
  const auto name = node.begin()->first.Scalar();
  const auto value = node.begin()->second;
  const auto at = path + "." + name;
  document.locate(at, node.begin()->first);
  const auto* kind = std::ranges::find(laws, name, &LawKind::name);
  if (kind == laws.end()) {
    std::vector<std::string> names;
    for (const auto& known : laws) names.emplace_back(known.name);
    document.error(at, "unknown friction law" + deck::suggestion(name, names));
  } else if (kind->has_value) {
    deck::Limits not_negative;
    not_negative.lower = 0;
    contact.law = kind->law;
    deck::Codec<double>::read(contact.friction, value, at, document, not_negative);
  } else {
    bool wanted = false;
    deck::Codec<bool>::read(wanted, value, at, document, {});
    contact.law = wanted ? kind->law : Law::frictionless;
  }
}

YAML::Node write_friction(const Options& contact)
{
  const auto* kind = std::ranges::find(laws, contact.law, &LawKind::law);
  if (kind == laws.end()) return {};
  YAML::Node node(YAML::NodeType::Map);
  node.SetStyle(YAML::EmitterStyle::Flow);
  node[std::string(kind->name)] = kind->has_value ? deck::Codec<double>::write(contact.friction) : YAML::Node(true);
  return node;
}

nlohmann::ordered_json friction_schema(const deck::Limits&)
{
  using Json = nlohmann::ordered_json;
  Json properties;
  for (const auto& kind : laws)
    properties[std::string(kind.name)] = kind.has_value ? Json{{"type", "number"}, {"minimum", 0}} : Json{{"type", "boolean"}};
  return {{"type", "object"},
          {"properties", std::move(properties)},
          {"additionalProperties", false},
          {"minProperties", 1},
          {"maxProperties", 1}};
}

// The rules of check_options that hold for `auto` as well, for the schema.
nlohmann::ordered_json gap_rules()
{
  using namespace deck;
  const auto bonded = given_as("friction", given_as("bonded", {{"const", true}}));
  return all_of({key_fits("clearance", {{"minimum", 0}}), when(given({"clearance"}), none_given({"adjust"})),
                 when(bonded, all_of({none_given({"adjust", "clearance"}), key_fits("interference", {{"const", 0}})}))});
}

// Those of pairs alone.
nlohmann::ordered_json pair_rules()
{
  using namespace deck;
  const auto bonded = given_as("friction", given_as("bonded", {{"const", true}}));
  return all_of({when(given({"preload"}), bonded),
                 when(given({"cyclic"}), all_of({none_given({"preload"}), key_fits("primary", {{"type", "string"}})}))});
}

// What goes together.
void check_options(const Options& contact, const std::string& path, deck::Document& document)
{
  if (contact.cyclic && contact.obstacle)
    document.error(path + ".cyclic", "a rigid obstacle is no sector's boundary; expected the name of one as primary");
  if (contact.cyclic && contact.preload)
    document.error(path + ".preload", "the cuts of a sector are no cut through a bolt; expected either cyclic or preload");
  if (contact.law == Law::bonded && contact.interference != 0)
    document.error(path + ".interference",
                   "bonded surfaces are tied where they are; expected another friction law, or no interference");
  for (const auto& [key, value] : {std::pair("adjust", contact.adjust), std::pair("clearance", contact.clearance)})
    if (value && contact.law == Law::bonded)
      document.error(path + "." + key,
                     "bonded surfaces are tied where they are, which is a gap of 0; leave it out, or take another friction law");
  if (contact.clearance && *contact.clearance < 0)
    document.error(path + ".clearance", fmt::format("a gap of {0:g} is an overlap; expected `clearance: 0, interference: {1:g}`",
                                                    *contact.clearance, -*contact.clearance));
  if (contact.adjust && contact.clearance)
    document.error(path + ".adjust",
                   "`clearance` replaces every gap of the meshes, and leaves none to adjust; expected one of the two");
  if (contact.preload && contact.law != Law::bonded)
    document.error(path + ".preload",
                   "only a cut through a bolt, which is bonded, can be preloaded; expected `friction: {bonded: true}` with it");
  if (!contact.automatic && !contact.obstacle && contact.secondary == contact.primary)
    document.error(
        path,
        fmt::format("secondary and primary are the same boundary \"{}\"; contact of a surface with itself is not available. Of a "
                    "boundary that two bodies share, each side is `body:boundary`",
                    contact.primary));
}

}  // namespace

std::string_view name_of(Law law)
{
  const auto* kind = std::ranges::find(laws, law, &LawKind::law);
  return kind == laws.end() ? std::string_view() : kind->name;
}

void describe(deck::Description<PreloadOptions>& d)
{
  d.help("Draws the two sides of a bonded contact, a cut through the shank of a bolt, together along the cut's mean normal.");
  d.key("force", &PreloadOptions::force,
        "Tension of the bolt, along the mean normal of its cut; how far that shortens it is found (plane models: a thickness; "
        "axisymmetric: of the whole turn).")
      .positive();
  d.key("shortening", &PreloadOptions::shortening, "How far the two sides are drawn together; the force is found.");
  d.rule(deck::one_given({"force", "shortening"}));
  d.check([](const PreloadOptions& preload, const std::string& path, deck::Document& document) {
    if (preload.force.has_value() == preload.shortening.has_value())
      document.error(path, fmt::format("expected either a force or a shortening, found {}", preload.force ? "both" : "neither"));
  });
}

void describe(deck::Description<Options>& d)
{
  d.help("A pair of boundaries that may touch.");
  d.key("name", &Options::name, "For results; secondary/primary if not given.");
  d.key("secondary", &Options::secondary,
        "Boundary that carries the multipliers: the finer or softer side. One that is more than twenty times stiffer than the "
        "primary side carries none if its faces are smaller, or bonded: the two are exchanged, which the log says.")
      .required();
  d.custom(
       "primary",
       "The boundary opposite, or a rigid obstacle: {plane: {point: [..], normal: [..]}}, {cylinder: {point: [..], axis: [..], "
       "radius: .., inside: false}} or {sphere: {center: [..], radius: .., inside: false}}.",
       [](Options& contact, const YAML::Node& node, const std::string& path, deck::Document& document,
          const deck::Limits& limits) {
         if (node.IsMap())
           read(contact.obstacle.emplace(), node, path, document);
         else
           deck::Codec<std::string>::read(contact.primary, node, path, document, limits);
       },
       [](const Options& contact) { return contact.obstacle ? write(*contact.obstacle) : YAML::Node(contact.primary); },
       [](const deck::Limits& limits) {
         return deck::schema_by_case({{"type", "string"}}, deck::Codec<std::string>::schema(limits), obstacle_schema());
       })
      .required();
  d.custom("friction", all_laws(&LawKind::value, " or ") + "; absent: frictionless.", read_friction, write_friction,
           friction_schema);
  std::vector<std::string> names;
  std::string help;
  for (const auto& kind : discretizations()) {
    names.emplace_back(kind.name);
    help += fmt::format("{}{}: {}", help.empty() ? "" : " ", kind.name, kind.help);
  }
  d.key("discretization", &Options::discretization, help).one_of(names);
  d.key("interference", &Options::interference, "Added overlap (press fit); negative opens a gap.");
  d.key("adjust", &Options::adjust,
        "Initial gaps and overlaps of the meshes up to this size count as zero; 0: they are taken as they are, also where the "
        "geometry says that the two faces are one surface.")
      .at_least(0);
  d.key("clearance", &Options::clearance,
        "The initial gap of the whole contact, >= 0, whatever the meshes say; 0 for a transition fit, and with `interference` "
        "for a "
        "press fit.");
  d.key("search_distance", &Options::search_distance,
        "Surfaces farther apart than this never meet, and Tresca's bound, which holds across gaps, ends there; 0 chooses a tenth "
        "of the smaller side's extent, or the longest face if that is longer.")
      .at_least(0);
  d.key("preload", &Options::preload,
        "{force: tension} or {shortening: length} of a bolt that is cut into two bodies, bonded here: bonded contacts alone.");
  d.key("cyclic", &Options::cyclic,
        "{axis: [..], angle: 360/n, center: [..]}: the model is one of n equal sectors, and this turn of 360/n degrees about the "
        "axis, positive by the right-hand rule or negative, brings the primary boundary to the secondary one, where the next "
        "sector begins. With `friction: {bonded: true}` the two are the cuts through the material, whose meshes need not match; "
        "with other laws sectors touch their neighbours "
        "there.");
  d.rule(gap_rules());
  d.rule(pair_rules());
  d.check(check_options);
}

void describe(deck::Description<AutoOptions>& d)
{
  d.help(
      "Finds all pairs of bodies whose outer faces face each other, named or not, and makes a contact body/body "
      "(secondary/primary; "
      "body/body.1, ... if they meet in several patches) of each. Pairs of bodies that another entry names are left to it. The "
      "secondary side is the softer one where the materials differ fourfold, else the finer one, else the flatter one.");
  d.custom(
       "auto", "true.",
       [](AutoOptions& options, const YAML::Node& node, const std::string& path, deck::Document& document,
          const deck::Limits& limits) {
         options.contact.automatic = true;
         bool wanted = true;
         deck::Codec<bool>::read(wanted, node, path, document, limits);
         if (!wanted) document.error(path, "expected true, or no such entry");
       },
       [](const AutoOptions&) { return YAML::Node(true); },
       [](const deck::Limits&) {
         return nlohmann::ordered_json{{"const", true}};
       })
      .required();
  const auto adopt = [&d](const std::string& name, const std::string& help) {
    for (const auto& key : deck::description<Options>().keys()) {
      if (key->name != name) continue;
      const auto* source = key.get();
      d.custom(
           name, help.empty() ? source->help : help,
           [source](AutoOptions& value, const YAML::Node& node, const std::string& path, deck::Document& document,
                    const deck::Limits& limits) { source->read(value.contact, node, path, document, limits); },
           [source](const AutoOptions& value) { return source->write(value.contact); }, source->schema)
          .limits = source->limits;
    }
  };
  adopt("name", "Of this entry, which load steps know: auto if not given; if it is given, contacts are called name.body/body.");
  adopt("friction", "");
  adopt("discretization", "");
  adopt("interference", "Added overlap of all these contacts; gaps that it closes are found as well.");
  adopt("adjust", "");
  adopt("clearance", "");
  adopt("search_distance",
        "Faces farther apart, or overlapping by more, are no pair, and never meet. 0: half the size (longest distance of two "
        "corners) "
        "of the smaller face; faces round those may come from as far away as the largest of these faces is long, or a fiftieth "
        "of the "
        "smaller body's diagonal.");
  d.rule(gap_rules());
  d.check([](const AutoOptions& options, const std::string& path, deck::Document& document) {
    deck::description<Options>().whole_check()(options.contact, path, document);
  });
}

void read_section(std::vector<Options>& contacts, const YAML::Node& node, const std::string& path, deck::Document& document)
{
  contacts.clear();
  if (node.IsNull()) return;
  if (node.IsScalar() && node.Scalar() == "auto") {
    contacts.emplace_back().automatic = true;
    return;
  }
  if (!node.IsSequence()) {
    document.error(path, "expected a list or `auto`, found " + deck::found(node));
    return;
  }
  for (std::size_t i = 0; i < node.size(); ++i) {
    const YAML::Node entry = node[i];
    const auto at = path + "[" + std::to_string(i) + "]";
    document.locate(at, entry);
    if (entry.IsMap() && entry["auto"]) {
      AutoOptions found;
      deck::Codec<AutoOptions>::read(found, entry, at, document, {});
      if (std::any_of(contacts.begin(), contacts.end(), [](const Options& other) { return other.automatic; }))
        document.error(at, "a second `auto` finds the same pairs as the first; list those that differ by their boundaries");
      contacts.push_back(std::move(found.contact));
    } else {
      deck::Codec<Options>::read(contacts.emplace_back(), entry, at, document, {});
    }
  }
}

YAML::Node write_section(const std::vector<Options>& contacts)
{
  YAML::Node node(YAML::NodeType::Sequence);
  for (const auto& contact : contacts)
    node.push_back(contact.automatic ? deck::Codec<AutoOptions>::write({contact}) : deck::Codec<Options>::write(contact));
  return node;
}

nlohmann::ordered_json section_schema()
{
  const nlohmann::ordered_json automatic{{"required", nlohmann::ordered_json::array({"auto"})}};
  auto entry = deck::schema_by_case({{"not", automatic}}, deck::Codec<Options>::schema({}), deck::Codec<AutoOptions>::schema({}));
  return deck::schema_by_case({{"type", "string"}}, {{"const", "auto"}}, {{"type", "array"}, {"items", std::move(entry)}});
}

}  // namespace mortise::contact
