// T'(B D^-1 B' + E) T + Sigma on the contact rows: T, what an active set leaves of them, E, what rows give way by, and Sigma, the
// curvatures of slip. The identity, but for rows that share nodes and pairs that may slip. Rows that hang together in this way
// (those of one contact, or of contacts that meet) make a block, which stands whole on one rank, that of its first row; no rank
// holds more.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/cholesky.hpp"
#include "feti/jump_operator.hpp"
#include "qp/problem.hpp"

namespace mortise::feti {

/// Refers to `jump`, which outlives it.
class ContactGram {
 public:
  /// nodal_stiffness[s][n]: D. `discs`: those in which contact rows of this rank slip. Collective.
  ContactGram(const JumpOperator& jump, const std::vector<std::vector<double>>& nodal_stiffness, int dimension,
              std::span<const qp::Disc> discs, const Communicator& comm);

  /// From now on T is the tangent at this rank's pairs `slips`, and the identity elsewhere, as it is at first; no row hangs
  /// together with the rows `fixed`. Collective.
  void fix(std::span<const Local> fixed, std::span<const qp::SlipDirection> slips);
  /// x becomes T (T'(B D^-1 B' + E) T + Sigma)^-1 T'x on the contact rows; nothing changes unless usable(). Collective.
  void apply_inverse(Vector& x) const;
  /// Whether the matrix has a factor, or no need of one.
  bool usable() const { return identity_ || usable_; }
  /// y += T Sigma T'x, if usable().
  void add_curvature(const Vector& x, Vector& y) const;

 private:
  struct Entry {
    Global row, column;
    double value;
  };
  std::vector<Entry> products(const std::vector<std::vector<double>>& nodal_stiffness, int dimension) const;
  std::vector<std::pair<Global, Global>> blocks_of(const std::vector<Entry>& entries) const;
  void place(const std::vector<Entry>& entries, std::span<const qp::Disc> discs);
  int unknown(int row) const;
  SparseMatrix free_part() const;
  void factorize(bool changed);
  std::size_t owner(Global row) const;
  Global row_of(Local row) const;

  const JumpOperator& jump_;
  Communicator comm_;
  std::vector<Global> first_;             // contact row of each rank; those of a rank follow each other
  bool identity_ = true;                  // on all ranks
  std::vector<std::vector<Local>> sent_;  // rows of this rank that stand in blocks, by the rank of the block
  std::vector<std::vector<int>> got_;     // rows of this rank's blocks, by the rank that owns them
  SparseMatrix matrix_;                   // B D^-1 B' + E of this rank's blocks, lower triangle
  // What an active set leaves of a row: all, or nothing. Of a pair that slips the first unknown of T is that along the tangent.
  struct Freedom {
    enum Kind { all, none, first, second } kind = all;
    double along = 1;  // component of the tangent
    double curvature = 0;
    bool operator==(const Freedom&) const = default;
  };
  std::vector<Freedom> freedom_;          // of the rows of these blocks
  SparseMatrix pattern_;                  // zeros wherever free_part() may have entries
  std::vector<qp::SlipDirection> slips_;  // of this rank's rows
  std::optional<Cholesky> factor_;        // of free_part()
  double trace_ = 0;                      // added to the diagonal of all, relative
  bool usable_ = false;
};

}  // namespace mortise::feti
