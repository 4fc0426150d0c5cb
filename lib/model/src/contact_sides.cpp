#include "contact_sides.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "model/patterns.hpp"
#include "partition/skin.hpp"

namespace mortise::model {

contact::ContactSides sides_of_contacts(const Model& model, const mesh::Surface* skin, const Communicator& comm)
{
  const auto& contacts = model.contacts().options;
  const auto& decomposition = model.decomposition();
  const auto& catalogue = decomposition.catalogue;
  std::map<int, std::vector<std::pair<std::string, int>>> sides;  // boundary: body's name, if any, and side
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].obstacle || (skin && contacts[c].cyclic)) continue;
    int side = 2 * static_cast<int>(c);
    for (const auto& name : {contacts[c].secondary, contacts[c].primary}) {
      const auto [boundary, body] = parse_boundary(name);
      const auto found = std::find(catalogue.boundaries.begin(), catalogue.boundaries.end(), boundary);
      sides[static_cast<int>(found - catalogue.boundaries.begin())].emplace_back(body, side++);
    }
  }
  struct Of {
    Global number;  // of a face or a node
    int side, body;
  };
  std::vector<Of> mine, nodes;
  for (const auto& subdomain : decomposition.subdomains) {
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.boundary.size(); ++f)
      if (const auto found = sides.find(facets.boundary[f]); found != sides.end())
        for (const auto& [body, side] : found->second)
          if (body.empty() || matches_name(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], body)) {
            mine.push_back({partition::face_number(subdomain.mesh, f), side, subdomain.body});
            if (skin)
              for (const Local n : facets.cells[f])
                nodes.push_back({subdomain.mesh.node_id[static_cast<std::size_t>(n)], side, subdomain.body});
          }
  }
  std::map<Global, std::set<std::pair<int, int>>> sides_at;  // of nodes: body and side
  for (const auto& [node, side, body] : comm.all_gather(nodes)) sides_at[node].emplace(body, side);
  for (std::size_t f = 0; skin && f < skin->faces.size(); ++f)
    for (const Local n : skin->faces[f])
      if (const auto found = sides_at.find(skin->node_id[static_cast<std::size_t>(n)]); found != sides_at.end())
        for (const auto& [body, side] : found->second)
          if (body == skin->body[f]) mine.push_back({skin->face_id[f], side, body});
  contact::ContactSides known;
  for (const auto& [face, side, body] : comm.all_gather(mine)) {
    auto& of_face = known.of_face[face];
    if (std::find(of_face.begin(), of_face.end(), side) == of_face.end()) of_face.push_back(side);
  }
  return known;
}

}  // namespace mortise::model
