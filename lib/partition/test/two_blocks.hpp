// Two blocks of 2 x 1 x 1 on each other, the upper one half a block aside, and how tests cut them.
#pragma once

#include <array>
#include <string>

#include "partition/decompose.hpp"

namespace mortise::partition {

/// In a plane the upper one stands above in y. `upper`: its cells.
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

/// decompose() without a log. Collective.
inline Decomposition cut_of(const mesh::Options& mesh, const Options& options, const Communicator& comm, int dimension = 3)
{
  Timers timers;
  Log log(comm, nullptr);
  return decompose(mesh, options, dimension, {comm, log, timers});
}

}  // namespace mortise::partition
