#include "output/blocks.hpp"

#include <algorithm>

#include "model/patterns.hpp"

namespace mortise::output {

namespace {

// The cells of a piece by their values in one of its cell fields, which are numbers from 0 on.
std::vector<std::vector<std::size_t>> cells_by(const io::Piece& piece, const std::string& field, std::size_t count)
{
  std::vector<std::vector<std::size_t>> result(count);
  for (const auto& f : piece.cell_fields)
    if (f.name == field)
      for (std::size_t c = 0; c < f.values.size(); ++c) result[static_cast<std::size_t>(f.values[c])].push_back(c);
  return result;
}

std::vector<std::string> boundaries_in_use(const model::Deck& deck)
{
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& support : deck.supports) add(support.boundary);
  for (const auto& load : deck.loads) add(load.boundary);
  for (const auto& [name, coupling] : deck.couplings) add(coupling.boundary);
  return names;
}

// The faces of a boundary, with the point fields of the volume.
io::Piece boundary_piece(const std::string& name, const partition::Decomposition& decomposition, const post::StressField& stress,
                         const Volume& volume)
{
  const auto [boundary, body] = model::parse_boundary(name);
  const auto& catalogue = decomposition.catalogue;
  const auto index = std::find(catalogue.boundaries.begin(), catalogue.boundaries.end(), boundary) - catalogue.boundaries.begin();
  io::Piece faces;
  faces.points = volume.piece.points;
  faces.point_fields = volume.piece.point_fields;
  std::vector<std::size_t> all;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& facets = subdomain.mesh.facets;
    const bool meant = body.empty() || model::matches_name(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], body);
    for (std::size_t f = 0; meant && f < facets.cells.size(); ++f) {
      if (facets.boundary[f] != index) continue;
      const auto material = material_of(subdomain, stress, s, static_cast<std::size_t>(facets.parent[f]));
      std::vector<Local> nodes;
      for (const Local n : facets.cells[f])
        nodes.push_back(volume.point(subdomain.mesh.node_id[static_cast<std::size_t>(n)], material));
      all.push_back(all.size());
      faces.cells.add(facets.cells.type[f], nodes);
    }
  }
  return io::part_of(faces, all);
}

}  // namespace

bool wants_blocks(const model::Deck& deck, const mesh::Catalogue& catalogue, std::size_t contacts)
{
  const auto count = catalogue.bodies.size() + contacts + boundaries_in_use(deck).size();
  const bool usual = count <= io::Options::usual_blocks && catalogue.node_count <= io::Options::usual_nodes;
  return deck.output.blocks.value.value_or(usual);
}

std::vector<io::Block> named_blocks(const model::Deck& deck, const partition::Decomposition& decomposition,
                                    const std::vector<contact::Pair>& pairs, const post::StressField& stress,
                                    const Volume& volume, const io::Piece& sides)
{
  std::vector<io::Block> blocks;
  const auto& bodies = decomposition.catalogue.bodies;
  const auto of_bodies = cells_by(volume.piece, "body", bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    blocks.push_back({"bodies", bodies[b].name, io::part_of(volume.piece, of_bodies[b])});
  const auto of_contacts = cells_by(sides, "contact", pairs.size());
  for (std::size_t c = 0; c < pairs.size(); ++c)
    blocks.push_back({"contacts", pairs[c].options.name, io::part_of(sides, of_contacts[c])});
  for (const auto& name : boundaries_in_use(deck))
    blocks.push_back({"boundaries", name, boundary_piece(name, decomposition, stress, volume)});
  return blocks;
}

}  // namespace mortise::output
