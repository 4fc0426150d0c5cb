// A supernodal Cholesky factor laid out for many solves.
//
// Each supernode is cut into pieces of at most 32 columns: a triangle, and a panel below it. Both are kept as tiles of 8 rows,
// column after column, filled up with zeros (ones on the diagonal), and read from the first number to the last forwards, and from
// the last tile to the first backwards. A tile meets a block of right-hand sides, interleaved, in registers; a factor that does
// not fit in the cache comes once for each block. CHOLMOD's own solve reads the zeros above the diagonal as well and calls dtrsm
// and dgemm for each supernode, which for small ones are mostly copying.
#pragma once

#include <cholmod.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace mortise {

/// How a factor is cut.
struct TilesOfFactor {
  static constexpr int tile = 8;

  /// Columns first .. first+width-1, and `tiles` tiles of rows below them.
  struct Piece {
    int first, width, tiles;
    std::size_t row,  ///< of rows(): the rows below, `tile` of them to a tile; filled up with the row size()
        value;        ///< of values(): blocks of 8 rows of the triangle, then the tiles of the panel
  };
};

/// Stored: double, or float: the factor is rounded to it, and arithmetic is that of doubles. So L~ L~' is exactly symmetric.
template <class Stored>
class SupernodalFactor : public TilesOfFactor {
 public:
  /// Copies a supernodal LL' factor.
  explicit SupernodalFactor(const cholmod_factor& factor);

  /// columns[c] <- A^-1 columns[c]. Not for two threads at once.
  void solve(std::span<double* const> columns) const;
  std::size_t bytes_in_double() const { return size_ * sizeof(double) + rows_.size() * sizeof(int); }

  std::span<const Piece> pieces() const { return pieces_; }
  const int* rows() const { return rows_.data(); }
  const Stored* values() const { return values_.get(); }

 private:
  std::vector<Piece> pieces_;
  std::vector<int> rows_;
  std::size_t size_ = 0;              // of values_
  std::unique_ptr<Stored[]> values_;  // filled once: to set it to zero before would cost half as much again
  std::vector<int> permutation_;      // row k of the factor is row permutation_[k] of the matrix
  mutable std::vector<double> work_;
};

}  // namespace mortise
