// The dual problem in displacements and multipliers, for a direct solution with sparse matrices.
#pragma once

#include <memory>

#include "base/cholesky.hpp"
#include "base/lazy.hpp"
#include "feti/dual_system.hpp"
#include "qp/solver.hpp"
#include "qp/sparse_newton.hpp"

namespace mortise::feti {

/// Rows of B, less supports that are eliminated, from which on a direct solution may take sparse matrices; below, dense ones take
/// a moment. And how many times the time of dense ones these are worth, which often need more guesses than are foreseen.
constexpr Global many_rows = 1000;
constexpr double worth_of_sparse = 2;

/// Operations of a direct solution with dense matrices, over `free` rows without a constraint and `closing` others; and with
/// sparse ones, for bodies of so many unknowns, whose factors together have so many entries.
double work_of_dense_solution(double free, double closing);
double work_of_sparse_solution(double entries, double unknowns);

class Gauges;
class RowsOnRoot;
class SupportElimination;
class WholeInverse;
class WholeProblem;

/// K and B of all subdomains as sparse matrices on rank 0. As an operator it is F^-1, by a sparse factor of its own. Heavy:
/// neither copies nor moves.
class SparseProblem : public qp::ActiveSetPreconditioner {
 public:
  /// When a direct solution should take these: never, after dense matrices have failed, before dense ones, or alone.
  enum class Turn { never, second, first, alone };
  /// Possible for bodies whose stiffness is sparse, without springs and without long rows over whole bodies but gauges of motions
  /// that nothing resists, which unknowns besides displacements (see Unknown) must not take part in. First where there are many
  /// rows and sparse matrices take less time; and alone if dense ones would take more than half a
  /// minute; second where they take no more than some times as long, or some seconds, or bodies
  /// are slender and solutions refined, of which dense matrices take one for each row. The same on every rank. Collective.
  static Turn turn(const DualSystem& system, bool slender);

  /// The system outlives it. `slender`: patient as of qp::SparseNewton, and exact as of qp::SparseInverse. Throws Error(machine)
  /// if memory runs out. Collective.
  explicit SparseProblem(const DualSystem& system, bool slender = false);
  ~SparseProblem() override;

  using Result = qp::ExplicitProgramme::Result;
  /// The solution in `set`, over the unknowns of DualSystem::set(), for f and c of `right`. Throws as qp::SparseNewton.
  /// Collective.
  Result solve(const qp::RightHandSide& right, const qp::FeasibleSet& set) const;
  /// The same for a linear term d and an e that differ from those of `right`, from a solution of a problem before on: its
  /// lambda, and its reaction, unless this problem was solved before. Nothing else is tried. Collective.
  Result go_on(const qp::RightHandSide& right, const Vector& linear, const Eigen::VectorXd& e, const qp::FeasibleSet& set,
               const Result& near) const;

  Teuchos::RCP<const Map> getDomainMap() const override { return system_.jump().rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return system_.jump().rows(); }
  /// y = alpha F^-1 x + beta y. Throws as qp::SparseInverse. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
  void fix(std::span<const Local>, std::span<const qp::SlipDirection>) override {}  // energy() is a bound over all x

 private:
  SparseMatrix stiffness_on_root(bool regularised) const;
  Eigen::SparseMatrix<double> motions_on_root() const;
  std::unique_ptr<const WholeInverse> make_inverse() const;
  Eigen::VectorXd on_root(const std::vector<Eigen::VectorXd>& parts) const;
  Result solve(const std::vector<Eigen::VectorXd>& f, const Eigen::VectorXd& bound, const Eigen::VectorXd& e,
               const qp::FeasibleSet& set, const Result* near) const;

  const DualSystem& system_;
  bool slender_;
  std::unique_ptr<const RowsOnRoot> rows_;
  std::vector<int> offset_;  // of the unknowns of this rank's subdomains among all; one past the last
  int unknowns_ = 0;         // of all subdomains of all ranks
  int others_ = 0;           // the unknowns besides, which come last and have no stiffness: see Unknown
  // On rank 0:
  std::unique_ptr<const Gauges> gauges_;
  std::unique_ptr<const SupportElimination> elimination_;
  std::unique_ptr<const SupportElimination> of_inverse_;  // without these unknowns, if there are any
  std::unique_ptr<WholeProblem> whole_;
  Lazy<std::unique_ptr<const WholeInverse>> inverse_;  // a factor as large as K's, for those who go on from a solution
};

}  // namespace mortise::feti
