// G of the equality constraint G x = e of the quadratic programme and the orthogonal projectors that belong to it:
//
//     Q = G' (G G')^-1 G,   P = I - Q.
//
// G is short and wide: its rows (the kernels of all subdomains) are few enough for every rank to hold a vector of them whole,
// its columns are distributed like x.
#pragma once

#include <memory>

#include "base/cholesky.hpp"
#include "base/communicator.hpp"
#include "base/tpetra.hpp"

namespace mortise::qp {

/// Heavy: moves, does not copy.
class EqualityConstraint {
 public:
  /// `g`: size x entries of x on this rank. Throws Error(no_equilibrium) if the rows of G are linearly dependent. Collective.
  EqualityConstraint(SparseMatrix g, const Communicator& comm);

  int size() const { return static_cast<int>(g_.rows()); }  ///< rows of G
  /// The columns of G that belong to this rank's entries of x.
  const SparseMatrix& local() const { return g_; }
  const SparseMatrix& gram() const { return gram_; }  ///< lower triangle of G G', on every rank
  const Communicator& communicator() const { return comm_; }

  /// G x, on every rank. Collective.
  Eigen::VectorXd apply(const Vector& x) const;
  /// y += alpha G' nu.
  void add_transpose(double alpha, const Eigen::VectorXd& nu, Vector& y) const;
  /// (G G')^-1 r, r of size(), the same on every rank.
  Eigen::VectorXd solve(const Eigen::VectorXd& r) const { return factor_->solve(r); }
  /// x = P x; returns (G G')^-1 G x of the x that came in. Collective.
  Eigen::VectorXd project(Vector& x) const;
  /// (r'(G G')^-1 r)^1/2, which is ||Q x|| for any x with G x = r: the norm of a residual r, the same on every rank, in which
  /// rows of different length count alike.
  double norm(const Eigen::VectorXd& r) const;

 private:
  Communicator comm_;
  SparseMatrix g_;
  SparseMatrix gram_;
  std::unique_ptr<Cholesky> factor_;
};

/// The lower triangle of the sum over the ranks of `part` (its lower triangle counts), whole on every rank. Collective.
SparseMatrix sum_over_ranks(const SparseMatrix& part, const Communicator& comm);

}  // namespace mortise::qp
