#include "surface/sent_surface.hpp"

#include <unordered_map>
#include <utility>

#include "base/packed.hpp"

namespace mortise::contact {

namespace {

// Some faces of a surface, or only their nodes, for each rank.
std::vector<std::vector<char>> messages_of(const mesh::Surface& surface, std::span<const std::vector<std::size_t>> chosen,
                                           std::span<const int> marks, bool nodes_alone)
{
  std::vector<std::vector<char>> messages;
  std::vector<std::size_t> taken(surface.points.size(), chosen.size());  // by the rank that a node goes to last
  for (std::size_t r = 0; r < chosen.size(); ++r) {
    SentSurface to_rank;
    for (const std::size_t f : chosen[r]) {
      if (!nodes_alone) to_rank.faces.push_back(pack_face(surface, f));
      if (!nodes_alone && !marks.empty()) to_rank.faces.back().mark = marks[f];
      for (const Local n : surface.faces[f])
        if (std::exchange(taken[static_cast<std::size_t>(n)], r) != r)
          to_rank.nodes.push_back(pack_node(surface, static_cast<std::size_t>(n)));
    }
    messages.push_back(to_rank.nodes.empty() ? std::vector<char>() : pack(to_rank));
  }
  return messages;
}

}  // namespace

SentNode pack_node(const mesh::Surface& surface, std::size_t node)
{
  const Point& x = surface.points[node];
  return {surface.node_id[node], {x[0], x[1], x[2]}};
}

SentFace pack_face(const mesh::Surface& surface, std::size_t face)
{
  SentFace sent{surface.face_id[face], {-1, -1, -1, -1, -1, -1, -1, -1, -1}, surface.faces.type[face]};
  const auto local = surface.faces[face];
  for (std::size_t k = 0; k < local.size(); ++k) sent.nodes[k] = surface.node_id[static_cast<std::size_t>(local[k])];
  return sent;
}

std::vector<char> pack(const SentSurface& surface)
{
  std::unordered_map<Global, Global> place;
  std::vector<Global> ids, faces, types, marks, nodes_of_faces;
  std::vector<double> x;
  for (const auto& node : surface.nodes) {
    place.emplace(node.id, static_cast<Global>(place.size()));
    ids.push_back(node.id);
    x.insert(x.end(), node.x.begin(), node.x.end());
  }
  for (const auto& face : surface.faces) {
    faces.push_back(face.id);
    types.push_back(static_cast<Global>(face.type));
    marks.push_back(face.mark);
    for (int k = 0; k < mesh::node_count(face.type); ++k)
      nodes_of_faces.push_back(place.at(face.nodes[static_cast<std::size_t>(k)]));
  }
  PackedWriter writer;
  writer.numbers(x);
  for (const auto& list : {ids, faces, types, marks, nodes_of_faces}) writer.integers(list);
  return writer.take();
}

void unpack(std::span<const char> message, SentSurface& surface)
{
  PackedReader reader(message);
  while (!reader.at_end()) {
    const auto x = reader.numbers();
    const auto ids = reader.integers(), faces = reader.integers(), types = reader.integers(), marks = reader.integers(),
               nodes_of_faces = reader.integers();
    for (std::size_t i = 0; i < ids.size(); ++i) surface.nodes.push_back({ids[i], {x[3 * i], x[3 * i + 1], x[3 * i + 2]}});
    auto node = nodes_of_faces.begin();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto type = static_cast<mesh::CellType>(types[f]);
      auto& face =
          surface.faces.emplace_back(SentFace{faces[f], {-1, -1, -1, -1, -1, -1, -1, -1, -1}, type, static_cast<int>(marks[f])});
      for (int k = 0; k < mesh::node_count(type); ++k)
        face.nodes[static_cast<std::size_t>(k)] = ids[static_cast<std::size_t>(*node++)];
    }
  }
}

std::vector<std::vector<char>> exchange_faces(const mesh::Surface& surface, std::span<const std::vector<std::size_t>> chosen,
                                              std::span<const int> marks, const Communicator& comm)
{
  return comm.exchange(messages_of(surface, chosen, marks, false));
}

std::vector<std::vector<char>> exchange_nodes(const mesh::Surface& surface, std::span<const std::vector<std::size_t>> chosen,
                                              const Communicator& comm)
{
  return comm.exchange(messages_of(surface, chosen, {}, true));
}

}  // namespace mortise::contact
