// A supernodal Cholesky factor laid out for many solves with few right-hand sides.
//
// Each supernode is cut into pieces of at most 32 columns: a packed triangle and a dense panel below it. A panel is read once
// forwards and once backwards, whatever the number of columns, which is what counts where factors do not fit in the cache; where
// they do, blocks of right-hand sides, interleaved, keep the arithmetic units busy. CHOLMOD's own solve reads the zeros above
// the diagonal as well and calls dtrsm and dgemm for each supernode, which for small ones are mostly copying.
#pragma once

#include <cholmod.h>

#include <vector>

namespace mortise {

class SupernodalFactor {
 public:
  /// Copies a supernodal LL' factor.
  explicit SupernodalFactor(const cholmod_factor& factor);

  /// x = A^-1 b, column-major with leading dimension `stride`; b may be x. Not for two threads at once.
  void solve(const double* b, double* x, int columns, int stride) const;
  std::size_t bytes() const { return values_.size() * sizeof(double) + rows_.size() * sizeof(int); }

 private:
  // Columns first .. first+width-1, and `height` rows below them.
  struct Piece {
    int first, width, height;
    std::size_t row,
        value;  // of rows_: the rows below; of values_: the triangle by columns, its diagonal inverted, then the panel
  };
  template <int Width>
  void solve_block(const double* b, double* x, int stride) const;
  void solve_few(const double* b, double* x, int columns, int stride) const;

  std::vector<Piece> pieces_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<int> permutation_;  // row k of the factor is row permutation_[k] of the matrix
  int tallest_ = 0;
  mutable std::vector<double> work_;
};

}  // namespace mortise
