// Sparse Cholesky factorization by CHOLMOD, supernodal, with its workspaces kept between solves.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <memory>
#include <span>

#include "base/types.hpp"

namespace mortise {

/// A sparse matrix in compressed columns; a symmetric one is given by its lower triangle.
using SparseMatrix = Eigen::SparseMatrix<Scalar, Eigen::ColMajor, int>;

/// P A P' = L L' of a symmetric positive definite matrix. Heavy: moves, does not copy. Its workspace changes with every
/// solve, so one object serves one thread.
class Cholesky {
 public:
  /// Orders and analyses the pattern of the lower triangle `lower`; no values are read. Where the unknowns are those of nodes
  /// with `block` components each, only the nodes are ordered, which takes a fraction of the time.
  explicit Cholesky(const SparseMatrix& lower, int block = 1);
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;
  ~Cholesky();

  /// Factorizes a matrix of the analysed pattern. Returns false if it is not positive definite: then nothing may be solved
  /// until a factorization succeeds. Throws Error(machine) when memory runs out.
  [[nodiscard]] bool factorize(const SparseMatrix& lower);

  /// Lays the factor out anew, smaller and quicker to solve with, for some time of a copy and as much memory for a moment.
  /// factorize() may be called again. Throws Error(machine) when memory runs out.
  void prepare_for_many_solves();

  /// The same, with the numbers of the factor rounded to single precision, and arithmetic in double: half of the memory, and
  /// little more than half of the time where factors come from memory. What solves then is A~^-1, symmetric to rounding as A^-1
  /// is, but not the same: the result is about the spectral radius of I - A~^-1 A, from forces at random, the same ones in every
  /// run. If it is more than `most`, the factor stays in double precision. `lower` is what was factorized, `block` as above.
  double prepare_in_single_precision(const SparseMatrix& lower, int block, double most);
  bool in_single_precision() const;

  /// x = A^-1 b for `columns` right-hand sides, column-major with leading dimension `stride` >= size(). b may be x.
  void solve(const double* b, double* x, int columns, int stride) const;
  /// A^-1 b, b of size().
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// columns[c] <- A^-1 columns[c], each of size(); many at once are quick after prepare_for_many_solves().
  void solve(std::span<double* const> columns) const;

  /// Rows of A.
  int size() const;
  /// Bytes that the factor takes in double precision, known from the analysis on.
  std::size_t factor_bytes() const;

 private:
  struct Data;
  void let_numbers_go();
  std::unique_ptr<Data> data_;
};

}  // namespace mortise
