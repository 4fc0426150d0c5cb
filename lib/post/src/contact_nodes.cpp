#include "contact_nodes.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "mesh/face_area.hpp"

namespace mortise::post {

namespace {

double size_of(const mesh::Surface& surface, std::size_t face)
{
  const auto nodes = surface.faces[face];
  const int corners = mesh::corner_count(surface.faces.type[face]);
  double result = 0;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < i; ++j)
      result = std::max(result, (surface.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])] -
                                 surface.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(j)])])
                                    .norm());
  return result;
}

// This rank's nodes of all sides.
std::vector<Nodal> own_nodes(std::span<const contact::Pair> pairs, const partition::Decomposition& decomposition,
                             const std::vector<Eigen::VectorXd>& displacement)
{
  std::unordered_map<Global, Nodal> seen;
  const auto look = [&](const mesh::Surface& surface, bool secondary) {
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const double size = size_of(surface, f);
      const Point normal = mesh::area_vector(surface.points, surface.faces[f], surface.faces.type[f]).normalized();
      const auto nodes = surface.faces[f];
      const auto corners = static_cast<std::size_t>(mesh::corner_count(surface.faces.type[f]));
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Global node = surface.node_id[static_cast<std::size_t>(nodes[i])];
        seen.try_emplace(node, Nodal{node})
            .first->second.take({node, {}, 0, secondary ? size : 0, size, {normal[0], normal[1], normal[2]}, 1, i < corners});
      }
    }
  };
  for (const auto& pair : pairs) {
    look(pair.secondary, true);
    if (pair.primary) look(*pair.primary, false);
  }
  const int dimension = decomposition.catalogue.dimension;
  std::vector<Nodal> result;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& ids = decomposition.subdomains[s].mesh.node_id;
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const auto found = seen.find(ids[n]);
      if (found == seen.end()) continue;
      Nodal& nodal = found->second;
      for (int c = 0; c < dimension; ++c) nodal.u[c] = displacement[s][static_cast<Eigen::Index>(n) * dimension + c];
      nodal.body = decomposition.subdomains[s].body;
      result.push_back(nodal);
      nodal = Nodal{ids[n]};  // other subdomains have no faces of their own there
    }
  }
  return result;
}

// Of the nodes asked for what all ranks know; nodes meet on rank node % ranks. Collective.
std::unordered_map<Global, Nodal> fetch(std::vector<Global> nodes, const std::vector<Nodal>& own, const Communicator& comm)
{
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Nodal>> told(ranks);
  std::vector<std::vector<Global>> wanted(ranks);
  for (const auto& nodal : own) told[static_cast<std::size_t>(nodal.node) % ranks].push_back(nodal);
  for (const Global node : nodes) wanted[static_cast<std::size_t>(node) % ranks].push_back(node);
  std::unordered_map<Global, Nodal> known;
  for (const auto& part : comm.exchange(told))
    for (const auto& nodal : part) {
      const auto [place, fresh] = known.emplace(nodal.node, nodal);
      if (!fresh) place->second.take(nodal);
    }
  std::vector<std::vector<Nodal>> answers(ranks);
  const auto asked = comm.exchange(wanted);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Global node : asked[r])
      if (const auto found = known.find(node); found != known.end()) answers[r].push_back(found->second);
  std::unordered_map<Global, Nodal> result;
  for (const auto& part : comm.exchange(answers))
    for (const auto& nodal : part) result.emplace(nodal.node, nodal);
  return result;
}

}  // namespace

bool touches(std::span<const contact::Pair> pairs, const contact::ContactNodeState& point)
{
  const auto& options = pairs[static_cast<std::size_t>(point.contact)].options;
  return point.status != contact::Status::open && options.law != contact::Law::bonded && !options.cyclic;
}

std::unordered_map<Global, Nodal> nodes_at_contact(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                                   std::span<const contact::ContactNodeState> states,
                                                   const partition::Decomposition& decomposition,
                                                   const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  std::vector<Global> wanted;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!touches(pairs, states[i])) continue;
    wanted.push_back(contacts.nodes[i].node);
    for (const auto& entry : contacts.rows[contacts.nodes[i].row]) wanted.push_back(entry.node);
  }
  return fetch(std::move(wanted), own_nodes(pairs, decomposition, displacement), comm);
}

}  // namespace mortise::post
