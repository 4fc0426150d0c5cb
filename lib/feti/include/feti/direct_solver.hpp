// Direct solvers for one subdomain, all behind Amesos2's interface.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cholesky.hpp"

namespace mortise::feti {

/// A factorization of one symmetric positive definite matrix. Heavy: moves, does not copy. One thread at a time.
class DirectSolver {
 public:
  /// Factorizes the matrix with lower triangle `lower`, of nodes with `block` components each, by the solver called `name`:
  /// one of names(). Throws Error(bad_input) for another name, also if the matrix is not positive definite, and
  /// Error(machine) if memory runs out. `most_rounded`: cholmod may round the factor to single precision, if that changes what it
  /// solves by no more than this (Cholesky::prepare_in_single_precision).
  DirectSolver(const std::string& name, const SparseMatrix& lower, int block = 1, std::optional<double> most_rounded = {});
  /// Of the solvers there are.
  static std::vector<std::string> names();

  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;
  ~DirectSolver();

  /// columns[c] <- A^-1 columns[c], each of the size of the matrix, by Amesos2::Solver::solve().
  void solve(std::span<double* const> columns) const;
  /// What rounding the factor has changed of its solutions, in the energy norm; 0 in double precision.
  double rounding() const;
  /// Bytes of the factor in double precision; 0 if the solver does not tell.
  std::size_t factor_bytes() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace mortise::feti
