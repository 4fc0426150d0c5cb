#include "io/options.hpp"

#include <algorithm>
#include <cctype>

#include "deck/cases.hpp"
#include "fem/quantity.hpp"

namespace mortise::io {

namespace {

using Points = std::vector<std::array<double, 3>>;

constexpr const char* only_cells = "cells";  // short for {cells: true}
constexpr int most_points = 100'000;         // of a path
// What is the same along all axes.
constexpr std::array<const char*, 4> quantities_alike{"von_mises", "principal_stress", "displacement", "pressure"};

bool goes_into_file_names(const std::string& name)
{
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

template <class Named>
void check_names(const std::map<std::string, Named>& named, const std::string& path, deck::Document& document)
{
  for (const auto& [name, value] : named)
    if (name.empty() || !goes_into_file_names(name))
      document.error(path + "." + name, "the name goes into file names: letters, digits, - and _ alone are for it");
}

// The rules of check_probe for the schema.
nlohmann::ordered_json probe_rules()
{
  using namespace deck;
  const auto path = all_of({given({"from", "to"}), none_given({"largest", "smallest", "point", "of"})});
  const nlohmann::ordered_json alike{{"enum", quantities_alike}};
  return all_of({schema_by_case(any_given({"from", "to"}), path,
                                all_of({one_given({"largest", "smallest", "point"}), none_given({"count"})})),
                 when(given({"point"}), none_given({"of"})), when(given_as("largest", alike), none_given({"axes"})),
                 when(given_as("smallest", alike), none_given({"axes"}))});
}

// One of the four kinds, and what belongs to it.
void check_probe(const ProbeOptions& probe, const std::string& path, deck::Document& document)
{
  const int kinds = static_cast<int>(!probe.largest.empty()) + static_cast<int>(!probe.smallest.empty()) +
                    static_cast<int>(probe.point.has_value()) + static_cast<int>(probe.from || probe.to);
  if (kinds != 1) {
    document.error(path, "expected one of `largest`, `smallest`, `point`, or `from` and `to`");
    return;
  }
  if (probe.from.has_value() != probe.to.has_value())
    document.error(path, std::string("a path has two ends; `") + (probe.from ? "to" : "from") + "` is missing");
  else if (probe.from && probe.from == probe.to)
    document.error(path + ".to", "a path has two ends, but both are the same point");
  if (probe.count && !probe.is_path()) document.error(path + ".count", "this is for paths, which have `from` and `to`");
  if (!probe.axes.empty() &&
      std::find(quantities_alike.begin(), quantities_alike.end(), probe.quantity()) != quantities_alike.end())
    document.error(path + ".axes", "this is for components, ux to sxz; " + probe.quantity() + " is the same along all axes");
  if (!probe.of.empty() && !probe.is_extreme()) document.error(path + ".of", "this is for `largest` and `smallest`");
}

void read_interior(Options& options, const YAML::Node& node, const std::string& path, deck::Document& document,
                   const deck::Limits& limits)
{
  if (node.IsScalar() && node.Scalar() == only_cells)
    options.interior.cells = true;
  else if (node.IsScalar())
    document.error(path, "expected cells, or a mapping such as {cells: true}, found " + deck::found(node));
  else
    deck::Codec<InteriorOptions>::read(options.interior, node, path, document, limits);
}

}  // namespace

void describe(deck::Description<PlaneOptions>& d)
{
  d.help("A plane that cuts bodies.");
  d.key("point", &PlaneOptions::point, "A point of it.").required();
  d.key("normal", &PlaneOptions::normal, "Across it, of any length.").required();
  d.key("size", &PlaneOptions::size,
        "In bodies of boundary elements no edge of the section's triangles is longer; default: a fiftieth of the body's size.")
      .positive();
  d.check([](const PlaneOptions& plane, const std::string& path, deck::Document& document) {
    if (plane.normal == std::array<double, 3>{0, 0, 0})
      document.error(path + ".normal", "expected a direction, found a zero vector");
  });
}

void describe(deck::Description<InteriorOptions>& d)
{
  d.help("Displacements and stresses inside bodies.");
  d.key("cells", &InteriorOptions::cells,
        "Bodies of boundary elements are written with the cells of the mesh and values at all nodes, not with their surface "
        "alone.");
  d.custom(
      "points",
      "Points in or on bodies, of any method: a list of coordinates, or a file, relative to the deck, with a point a line. "
      "Displacement and stress there go into interior.csv and results.h5.",
      [](InteriorOptions& interior, const YAML::Node& node, const std::string& path, deck::Document& document,
         const deck::Limits& limits) {
        if (node.IsScalar())
          deck::Codec<std::string>::read(interior.point_file, node, path, document, limits);
        else
          deck::Codec<Points>::read(interior.points, node, path, document, limits);
      },
      [](const InteriorOptions& interior) {
        return interior.point_file.empty() ? deck::Codec<Points>::write(interior.points)
                                           : deck::Codec<std::string>::write(interior.point_file);
      },
      [](const deck::Limits& limits) {
        return deck::schema_by_case({{"type", "string"}}, deck::Codec<std::string>::schema(limits),
                                    deck::Codec<Points>::schema(limits));
      });
  d.key("planes", &InteriorOptions::planes, "Sections through all bodies by their names; plane.NAME.pvd shows the fields there.");
  d.check([](const InteriorOptions& interior, const std::string& path, deck::Document& document) {
    check_names(interior.planes, path + ".planes", document);
  });
}

std::vector<std::array<double, 3>> ProbeOptions::points() const
{
  if (point) return {*point};
  std::vector<std::array<double, 3>> result;
  if (!from || !to) return result;
  const int last = count.value_or(usual_count) - 1;
  for (int i = 0; i <= last; ++i) {
    auto& x = result.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) x[c] = ((*from)[c] * (last - i) + (*to)[c] * i) / last;
  }
  return result;
}

bool Options::has_field(const std::string& name) const
{
  return std::find(fields.begin(), fields.end(), name) != fields.end();
}

bool Options::asks_inside() const
{
  return interior.any() ||
         std::any_of(probes.begin(), probes.end(), [](const auto& probe) { return !probe.second.is_extreme(); });
}

void describe(deck::Description<ProbeOptions>& d)
{
  d.help("What is followed through all load steps: an extreme value, the values at a point, or those along a straight path.");
  d.key("largest", &ProbeOptions::largest,
        "The largest value of this quantity at the nodes, and where it is; of principal_stress the largest of the three, of "
        "displacement its length.")
      .one_of(fem::quantity_names());
  d.key("smallest", &ProbeOptions::smallest, "The smallest one; of principal_stress the smallest of the three.")
      .one_of(fem::quantity_names());
  d.key("of", &ProbeOptions::of,
        "Where to look for the extreme: a body, a boundary or body:boundary, `*` for any text; for pressure also a contact. "
        "Default: everywhere.");
  d.key("point", &ProbeOptions::point, "A point in or on a body: displacement and stresses there.");
  d.key("from", &ProbeOptions::from, "Where a path begins: displacement and stresses along it go into probe.NAME.csv.");
  d.key("to", &ProbeOptions::to, "Where a path ends.");
  d.key("axes", &ProbeOptions::axes,
        "Local axes, by their name in the section `axes`, that components are along: of cylindrical ones x, y and z are radial, "
        "tangential and axial.");
  d.key("count", &ProbeOptions::count, "Points on a path, both ends among them; default: 21.").at_least(2).below(most_points + 1);
  d.check(check_probe);
  d.rule(probe_rules());
}

void describe(deck::Description<Options>& d)
{
  d.help("What is written where.");
  d.key("directory", &Options::directory, "Relative to the deck; default: <deck name>.out beside the deck.");
  d.key("fields", &Options::fields,
        "Fields of solution.pvd and of sections; reaction_force is what holds each node that a support holds, supports and "
        "contact together; contact_pressure stands on both sides of a contact, on the primary one as what presses there.")
      .one_of({"displacement", "von_mises", "stress", "principal_stress", "reaction_force", "contact_pressure"});
  d.key(
      "blocks", &Options::blocks,
      "Whether blocks.pvd is written, in which bodies, contacts and held or loaded boundaries are blocks with their names, to be "
      "shown or hidden one by one; auto: where these are at most 40, of at most 30,000 nodes.");
  d.key("axes", &Options::axes,
        "Local axes, by their name in the section `axes`: displacements and stresses are written along these as well, as the "
        "fields "
        "displacement_local and stress_local.");
  d.key("every", &Options::every,
        "Of each load step every so many increments and the last one are written to solution.pvd, contact.pvd, sections and "
        "results.h5.")
      .at_least(1);
  d.key("moments_about", &Options::moments_about, "The point that moments of reactions are about.");
  d.key("probes", &Options::probes, "What is followed through all load steps, by names: see probes.csv.");
  d.custom(
      "interior", "What to find out about the inside of bodies; `cells` is short for {cells: true}.", read_interior,
      [](const Options& options) { return deck::Codec<InteriorOptions>::write(options.interior); },
      [](const deck::Limits& limits) {
        return deck::schema_by_case({{"type", "string"}}, {{"const", only_cells}}, deck::Codec<InteriorOptions>::schema(limits));
      });
  d.check([](const Options& output, const std::string& path, deck::Document& document) {
    check_names(output.probes, path + ".probes", document);
  });
}

}  // namespace mortise::io
