#include "io/options.hpp"

#include <algorithm>
#include <cctype>

namespace mortise::io {

namespace {

using Points = std::vector<std::array<double, 3>>;

constexpr const char* only_cells = "cells";  // short for {cells: true}

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
        return nlohmann::ordered_json{{"anyOf", {deck::Codec<Points>::schema(limits), deck::Codec<std::string>::schema(limits)}}};
      });
  d.key("planes", &InteriorOptions::planes, "Sections through all bodies by their names; plane.NAME.pvd shows the fields there.");
  d.check([](const InteriorOptions& interior, const std::string& path, deck::Document& document) {
    for (const auto& [name, plane] : interior.planes)
      if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }))
        document.error(path + ".planes." + name, "the name goes into file names: letters, digits, - and _ alone are for it");
  });
}

void describe(deck::Description<Options>& d)
{
  d.help("What is written where.");
  d.key("directory", &Options::directory, "Relative to the deck; default: <deck name>.out beside the deck.");
  d.key("fields", &Options::fields, "Volume fields to write.").one_of({"displacement", "von_mises", "stress"});
  d.custom(
      "interior", "What to find out about the inside of bodies; `cells` is short for {cells: true}.", read_interior,
      [](const Options& options) { return deck::Codec<InteriorOptions>::write(options.interior); },
      [](const deck::Limits& limits) {
        return nlohmann::ordered_json{{"anyOf", {{{"const", only_cells}}, deck::Codec<InteriorOptions>::schema(limits)}}};
      });
}

}  // namespace mortise::io
