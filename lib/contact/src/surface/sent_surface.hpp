// Nodes and faces of a surface on their way between ranks.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

struct SentNode {
  Global id;
  std::array<double, 3> x;
};
struct SentFace {
  Global id;
  std::array<Global, 9> nodes;  ///< -1: none
  mesh::CellType type;
  int mark = 0;  ///< told besides: in a share the rank that has it (share.hpp), of a skin the body
};
SentNode pack_node(const mesh::Surface& surface, std::size_t node);
SentFace pack_face(const mesh::Surface& surface, std::size_t face);

struct SentSurface {
  std::vector<SentNode> nodes;
  std::vector<SentFace> faces;
};

/// A message of few bytes. `nodes` has all nodes of the faces, each once.
std::vector<char> pack(const SentSurface& surface);
/// Appends what one message, or several behind each other, hold.
void unpack(std::span<const char> message, SentSurface& surface);

/// Sends the faces chosen[r] of a surface, and their nodes, to rank r; `marks`: of all faces, or none. The messages that came
/// from each rank. Collective.
std::vector<std::vector<char>> exchange_faces(const mesh::Surface& surface, std::span<const std::vector<std::size_t>> chosen,
                                              std::span<const int> marks, const Communicator& comm);
/// The same with the nodes alone.
std::vector<std::vector<char>> exchange_nodes(const mesh::Surface& surface, std::span<const std::vector<std::size_t>> chosen,
                                              const Communicator& comm);

}  // namespace mortise::contact
