#include "io/options.hpp"

namespace mortise::io {

namespace {

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

void describe(deck::Description<InteriorOptions>& d)
{
  d.help("Displacements and stresses inside bodies.");
  d.key("cells", &InteriorOptions::cells,
        "Bodies of boundary elements are written with the cells of the mesh and values at all nodes, not with their surface "
        "alone.");
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
