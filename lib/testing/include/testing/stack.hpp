// A block that stands on the nodes of another one.
#pragma once

#include "testing/blocks.hpp"

namespace mortise::feti {

/// A cube of edge 1 and 3 x 3 x 2 hexahedra from z = 0, one subdomain, and one on it with 3 x 3 hexahedra in its plane.
/// Supports, loads and rows are to come.
struct Stack : Blocks {
  struct Upper {
    double height;
    int cells, pieces;  // along z
  };
  Stack(const Upper& upper, double young, MPI_Comm mpi = MPI_COMM_WORLD, const Rotation& rotation = {})
      : Blocks(
            {{"lower", {{0, 0, 0}, {1, 1, 1}, {3, 3, 2}, "hex8"}},
             {"upper", {{0, 0, 1}, {1, 1, upper.height}, {3, 3, upper.cells}, "hex8"}}},
            {{"lower", {1, 1, 1}}, {"upper", {1, 1, upper.pieces}}}, [young](int) { return young; }, mpi, 1, rotation)
  {
  }
};

}  // namespace mortise::feti
