// Springs: rows that are held not fast but elastically. Where the rows of a support say B u = 0, those of springs say
//
//     B u = A^-1 lambda,   lambda = A (B u),
//
// A symmetric positive definite over all of them, so that F becomes F + A^-1 on these rows. Every rank knows all of them, for A
// couples rows of a boundary wherever they stand; a row itself stands on one rank.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/cholesky.hpp"
#include "constraint/entry.hpp"
#include "deck/description.hpp"
#include "deck/place.hpp"

namespace mortise::constraint {

/// One row: a displacement along a direction, at a node or between two.
struct SpringRow {
  std::vector<Entry> entries;
  int support = -1;                   ///< index into the deck's supports, or -1
  int spring = -1;                    ///< index into the deck's springs, by name, or -1
  std::array<double, 3> direction{};  ///< unit
  std::array<double, 3> at{};         ///< the node's place; of two the first one's
  bool along_normal = false;          ///< of its boundary, which slides along itself
};

/// All springs of an assembly.
struct Springs {
  std::vector<SpringRow> rows;   ///< of all ranks, the same on every one
  SparseMatrix stiffness;        ///< A, both triangles: force per length
  std::vector<std::size_t> own;  ///< those of `rows` that stand on this rank
};

/// One entry of the deck's section `springs`: between two nodes, along the line from one to the other.
struct SpringOptions {
  std::vector<deck::Place> points;
  std::vector<std::string> bodies;  ///< none, or that of each point
  double stiffness = 0;             ///< force per length
};

/// The keywords.
void describe(deck::Description<SpringOptions>& d);

}  // namespace mortise::constraint
