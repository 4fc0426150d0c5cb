// Sparse LU factorization by UMFPACK, with pivots chosen by size: for indefinite matrices, and those of which a Cholesky factor
// would lose what is soft.
#pragma once

#include <memory>

#include "base/cholesky.hpp"

namespace mortise {

/// P (R A) Q = L U of a square matrix. Heavy: moves, does not copy.
class SparseLu {
 public:
  /// None if A is singular to rounding. Throws Error(machine) when memory runs out.
  [[nodiscard]] static std::unique_ptr<const SparseLu> factorized(SparseMatrix a);
  ~SparseLu();
  SparseLu(SparseLu&&) = delete;
  SparseLu& operator=(SparseLu&&) = delete;

  /// A^-1 b, b of as many entries as A has rows.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Data;
  explicit SparseLu(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace mortise
