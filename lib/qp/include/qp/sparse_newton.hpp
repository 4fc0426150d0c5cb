// Exact solution of a contact problem in displacements and multipliers, by the direct method of condensed_newton.hpp with sparse
// matrices: for many multipliers, where a dense compliance takes n^3 operations, and for bodies whose stiffness has small
// factors, as plates.
//
//     minimise 1/2 u'K u - f'u + ..:   K u + B'x = f,   s = c - B u + S x,   s in the normal cone of Omega at x.
//
// With K_r positive definite, K_r^-1 a generalised inverse of K and R the kernel of K, x solves the programme of problem.hpp with
// A = B K_r^-1 B' + S, b = B K_r^-1 f - c, G = R'B', e = R'f. An interior point method leads from soft contact near the solution
// (src/central_path.hpp), and guesses of states end it: some 15 to 40 sparse factors.
#pragma once

#include <memory>

#include "base/cholesky.hpp"
#include "base/extended.hpp"
#include "qp/condensed_newton.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

struct SparseMatrices {
  SparseMatrix k;  ///< K, lower triangle: symmetric, positive semidefinite; what has no stiffness rows alone hold
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> b;  ///< B: rows x unknowns of K
  Eigen::VectorXd s;                                    ///< S, diagonal: what rows give way by themselves
};

/// On one rank alone. Heavy: neither copies nor moves.
class SparseNewton {
 public:
  /// `patient`: where states are not found at once, or rounding decides them, problems of some thousand unknowns are searched as
  /// those of CondensedNewton are. Where nothing balances the loads that may end with what is no solution.
  explicit SparseNewton(SparseMatrices matrices, bool patient = false);

  /// Result::nu is u, Result::reaction s, of all rows. `set` over the rows of B; rows that are in none of its factors are
  /// equations. Throws Error(interrupted) if the process is told to end, and Error(machine) if memory runs out. `near`: the
  /// solution of a problem before, with its reaction, from whose states guesses go on; nothing else is tried then.
  CondensedNewton::Result solve(const Eigen::VectorXd& f, const Eigen::VectorXd& c, const FeasibleSet& set,
                                const CondensedNewton::Result* near = nullptr) const;

 private:
  SparseMatrices matrices_;
  bool patient_;
};

/// (B K^-1 B' + S)^-1 for a positive definite K. Heavy: moves, does not copy.
class SparseInverse {
 public:
  /// `whole`: with nothing eliminated, unless bodies are large; what bends softly is lost otherwise. Throws Error(not_converged)
  /// if K is not positive definite to rounding, and Error(machine) if memory runs out.
  explicit SparseInverse(SparseMatrices matrices, bool whole = false);
  ~SparseInverse();
  SparseInverse(SparseInverse&&) noexcept;
  SparseInverse& operator=(SparseInverse&&) noexcept;

  /// x with B u + S x = r, K u = f + B'x; returns u, too.
  struct Result {
    Eigen::VectorXd x;
    ExtendedVector u;
  };
  Result solve(const Eigen::VectorXd& r, const Eigen::VectorXd& f) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace mortise::qp
