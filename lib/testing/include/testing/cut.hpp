// Models as tests cut them, and their boundaries.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "partition/decompose.hpp"
#include "partition/node_directory.hpp"
#include "testing/quiet.hpp"

namespace mortise::partition {

/// decompose() without a log. Collective.
inline Decomposition cut_of(const mesh::Options& mesh, const Options& options, const Communicator& comm, int dimension = 3)
{
  Timers timers;
  Log log(comm, nullptr);
  return decompose(mesh, options, dimension, {comm, log, timers});
}

/// The copies of all nodes, each with the same weight. Collective.
inline NodeDirectory even_directory(const Decomposition& decomposition, const Communicator& comm)
{
  std::vector<std::vector<double>> weights;
  for (const auto& s : decomposition.subdomains) weights.emplace_back(s.mesh.node_count(), 1.0);
  return {decomposition, weights, comm};
}

/// The index of a boundary.
inline int boundary_index(const Decomposition& decomposition, const std::string& name)
{
  const auto& names = decomposition.catalogue.boundaries;
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// This rank's faces of a boundary.
inline mesh::Surface side_of(const Decomposition& decomposition, const std::string& name)
{
  return boundary_surface(decomposition, boundary_index(decomposition, name),
                          std::vector<bool>(decomposition.catalogue.bodies.size(), true));
}

/// Two blocks of 2 x 1 x 1 on each other, the upper one half a block aside; in a plane it stands above in y. `upper`: its cells.
inline mesh::Options two_blocks(const std::string& element, std::array<int, 3> lower, std::array<int, 3> upper,
                                bool plane = false)
{
  mesh::Options options;
  mesh::BlockOptions block;
  block.size = {2, 1, 1};
  block.cells = lower;
  block.element = element;
  options.blocks["lower"] = options.blocks["upper"] = block;
  options.blocks["upper"].origin = plane ? std::array<double, 3>{0.5, 1, 0} : std::array<double, 3>{0.5, 0, 1};
  options.blocks["upper"].cells = upper;
  return options;
}

}  // namespace mortise::partition
