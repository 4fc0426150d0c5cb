// B D^-1 B' on the contact rows, and what rows give way by: the identity, but for rows that share nodes. Rows that hang together in this way (those of one
// contact, or of contacts that meet) make a block, which stands whole on one rank, that of its first row; no rank holds more.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/cholesky.hpp"
#include "feti/jump_operator.hpp"

namespace mortise::feti {

/// Refers to `jump`, which outlives it.
class ContactGram {
 public:
  /// nodal_stiffness[s][n]: D. Collective.
  ContactGram(const JumpOperator& jump, const std::vector<std::vector<double>>& nodal_stiffness, int dimension,
              const Communicator& comm);

  /// From now on it is the identity on the rows `fixed` of this rank. Collective.
  void fix(std::span<const Local> fixed);
  /// x becomes (B D^-1 B')^-1 x on the contact rows; nothing where the matrix has no factor. Collective.
  void apply_inverse(Vector& x) const;

 private:
  struct Entry {
    Global row, column;
    double value;
  };
  std::vector<Entry> products(const std::vector<std::vector<double>>& nodal_stiffness, int dimension) const;
  std::vector<std::pair<Global, Global>> blocks_of(const std::vector<Entry>& entries) const;
  void place(const std::vector<Entry>& entries);
  void factorize(bool changed);
  std::size_t owner(Global row) const;

  const JumpOperator& jump_;
  Communicator comm_;
  std::vector<Global> first_;             // contact row of each rank; those of a rank follow each other
  bool identity_ = true;                  // on all ranks
  std::vector<std::vector<Local>> sent_;  // rows of this rank that stand in blocks, by the rank of the block
  std::vector<std::vector<int>> got_;     // rows of this rank's blocks, by the rank that owns them
  SparseMatrix matrix_;                   // this rank's blocks, lower triangle
  std::vector<char> fixed_;               // of its rows
  std::optional<Cholesky> factor_;        // of what is not fixed
  double trace_ = 0;                      // added to the diagonal of all, relative
  bool usable_ = false;
};

}  // namespace mortise::feti
