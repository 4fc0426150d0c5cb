// The dual problem in displacements and multipliers, for a direct solution with sparse matrices.
#pragma once

#include <memory>

#include "base/cholesky.hpp"
#include "feti/dual_problem.hpp"
#include "qp/sparse_newton.hpp"

namespace mortise::feti {

/// Rows of B, less supports that are eliminated, from which on a direct solution may take sparse matrices; below, dense ones take
/// a moment. And how many times the time of dense ones these are worth, which often need more guesses than are foreseen.
constexpr Global many_rows = 2500;
constexpr double worth_of_sparse = 3;

/// Operations of a direct solution with dense matrices, over `free` rows without a constraint and `closing` others; and with sparse
/// ones, for bodies of so many unknowns, whose factors together have so many entries.
double work_of_dense_solution(double free, double closing);
double work_of_sparse_solution(double entries, double unknowns);

/// K and B of all subdomains as sparse matrices, less supports that hold one unknown each. As an operator it is F^-1, by a sparse
/// factor of its own. On one rank. Heavy: neither copies nor moves.
class SparseProblem : public qp::ActiveSetPreconditioner {
 public:
  /// Whether there are many rows, and sparse matrices take less time: on one rank, for bodies whose stiffness is sparse, with
  /// nothing but rigid motions in G, without springs and without rows over whole bodies (gauges).
  static bool suits(const DualProblem& problem);

  /// The problem outlives it.
  explicit SparseProblem(const DualProblem& problem);
  ~SparseProblem() override;

  struct Result {
    Vector x;                ///< lambda, over the rows of B
    Eigen::VectorXd nu;      ///< of the motions of all subdomains
    bool converged = false;  ///< exact to rounding; else the last guess
    int steps = 0;           ///< linear problems solved
    Vector reaction;         ///< F lambda - d + G'nu by these matrices, zero at rows without a constraint
  };
  /// The solution for the loads, bounds and slip bounds that the problem has when this is called. Throws as qp::SparseNewton.
  Result solve() const;
  /// The same for another linear term d and another e, that differ by little: from the last solution on, whose lambda is given.
  Result go_on(const Vector& linear, const Eigen::VectorXd& e, const Vector& near) const;

  Teuchos::RCP<const Map> getDomainMap() const override { return problem_.jump().rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return problem_.jump().rows(); }
  /// y = alpha F^-1 x + beta y. Throws as qp::SparseInverse.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
  void fix(std::span<const Local>) override {}  // energy() is a bound over all x, and so over those with zeros

 private:
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
  // A row that holds one unknown.
  struct Support {
    Local row;
    int unknown;
    double coefficient;
  };

  void choose_supports();
  qp::SparseMatrices reduced(const SparseMatrix& stiffness) const;
  qp::FeasibleSet reduced_set() const;
  Eigen::VectorXd held(const Eigen::Ref<const Eigen::VectorXd>& bounds) const;
  Result solve(const Eigen::VectorXd& f, const Eigen::VectorXd& bound, const Vector* near) const;
  Vector complete(const Eigen::VectorXd& kept, const Eigen::VectorXd& forces) const;

  const DualProblem& problem_;
  std::vector<int> offset_;  // of each subdomain's unknowns
  SparseMatrix stiffness_;   // K, lower triangle
  Rows rows_;                // B
  std::vector<Support> supports_;
  std::vector<int> free_;               // unknowns that no support holds
  std::vector<int> kept_;               // rows that are none of these,
  std::vector<Local> number_;           // and their numbers, -1 for others
  std::unique_ptr<qp::SparseNewton> newton_;
  mutable Eigen::VectorXd last_, last_reaction_;        // displacements of the last solution, and s of its rows
  mutable SparseMatrix regularised_;                    // what K^+ is the inverse of, lower triangle,
  mutable std::unique_ptr<qp::SparseInverse> inverse_;  // once F^-1 is asked for
};

}  // namespace mortise::feti
