// Where bodies are and how fine they are: whether coordinates in double precision can tell their nodes apart.
#pragma once

#include <string>
#include <vector>

#include "mesh/instances.hpp"
#include "mesh/mesh.hpp"
#include "mesh/options.hpp"

namespace mortise::mesh {

/// A box around a body, and the shortest edge of its cells between corners.
struct Extent {
  Point low = Point::Zero(), high = Point::Zero();
  double shortest_edge = 0;
};

/// The extent of each body of a mesh, `bodies` in all; of each block.
std::vector<Extent> extents(const Mesh& mesh, std::size_t bodies);
std::vector<Extent> block_extents(const Options& options, int dimension);

/// The sizes that a model may have, so that products of several volumes stay in the range of doubles.
inline constexpr double smallest_size = 1e-30, largest_size = 1e30;

/// Throws Error(bad_input) if a body of the assembly has coordinates that are no finite numbers, is too large or too small, or
/// lies so far from the origin that rounding moves its nodes by more than a millionth of an edge. `of_parts`: of each body of the
/// parts, before it is moved; `source`, the file or "mesh.blocks", stands in front of the message.
void require_resolved(const Layout& layout, const std::vector<Extent>& of_parts, const std::string& source);

/// Throws Error(machine) if there are more cells than can be numbered, or they do not fit into this machine's memory: the blocks
/// as one piece (`whole`), and a rank's share of the assembly. To be asked before they are made.
void require_room(const Options& blocks, int dimension, bool whole);
void require_room(const Catalogue& assembly, int ranks);

}  // namespace mortise::mesh
