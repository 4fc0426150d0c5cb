// The dual problem as matrices, for a direct solution.
#pragma once

#include "feti/dual_system.hpp"
#include "qp/condensed_newton.hpp"
#include "qp/solver.hpp"

namespace mortise::feti {

class DirichletElimination;
class RowsOnRoot;

/// So many rows of supports along axes are not worth an elimination. It costs figures where F is large beside what balanced
/// forces do, as on a thin plate: the products with F that show a solution to be one have the rounding of another factor.
constexpr Global few_supports = 2000;

/// F and G on rank 0 over the rows that are left when supports along axes are eliminated; of use where these are some thousand.
/// As an operator it is F^-1, the best of all preconditioners. Heavy: neither copies nor moves.
class ExplicitProblem : public qp::ActiveSetPreconditioner {
 public:
  /// If there are more than `few` supports along axes, factorizes each subdomain that has any with them, and solves for the
  /// columns of its inverse times B', as many as its other rows of B. Not for clusters of several subdomains. The system
  /// outlives it. Throws as qp::CondensedNewton, Error(bad_input) if a supported subdomain is not positive definite, and
  /// Error(machine) if memory runs out. Collective.
  explicit ExplicitProblem(const DualSystem& system, Global few = few_supports);
  ~ExplicitProblem() override;

  using Result = qp::ExplicitProgramme::Result;
  /// The solution in `set`, over the unknowns of DualSystem::set(), for the linear term d and for e, the same on every rank.
  /// `near`: the solution of a problem before, with its reaction, to go on from; nothing else is tried. Collective.
  Result solve(const Vector& linear, Eigen::VectorXd e, const qp::FeasibleSet& set, const Result* near = nullptr) const;
  /// Whether the matrices differ from F by a little: where rows depend on each other they have some compliance that F has not,
  /// and where supports are eliminated the rounding of other factors. The same on every rank.
  bool differs() const { return separated_ || eliminated_; }

  Teuchos::RCP<const Map> getDomainMap() const override { return system_.jump().rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return system_.jump().rows(); }
  /// y = alpha F^-1 x + beta y. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
  void fix(std::span<const Local>, std::span<const qp::SlipDirection>) override {}  // energy() is a bound over all x

 private:
  const DualSystem& system_;
  std::unique_ptr<const DirichletElimination> elimination_;
  std::unique_ptr<const RowsOnRoot> rows_;
  std::unique_ptr<qp::CondensedNewton> newton_;  // rank 0
  bool separated_ = false, eliminated_ = false;
};

}  // namespace mortise::feti
